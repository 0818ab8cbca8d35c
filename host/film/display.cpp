#include "reradiant/spectral_image.h"

#include "host/base/logging.h"
#include "host/film/colour_image.h"
#include "host/film/display_picture.h"
#include "host/film/png.h"
#include "reradiant/error.h"

#include <OpenColorIO/OpenColorIO.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace OCIO = OCIO_NAMESPACE;

namespace reradiant {

namespace {

constexpr std::string_view builtin_prefix = "DISPLAY - CIE-XYZ-D65_to_";
constexpr const char* builtin_view = "Standard";

/// A processor from CIE XYZ (white D65 with Y = 1) to the display's code values.
struct DisplayProcessor {
    OCIO::ConstCPUProcessorRcPtr processor;
    bool is_srgb = false;
};

std::vector<std::string> builtin_displays() {
    std::vector<std::string> names;
    const auto registry = OCIO::BuiltinTransformRegistry::Get();
    for (std::size_t i = 0; i < registry->getNumBuiltins(); ++i) {
        const std::string_view style = registry->getBuiltinStyle(i);
        if (style.starts_with(builtin_prefix))
            names.emplace_back(style.substr(builtin_prefix.size()));
    }
    return names;
}

void check_name(const char* what, const std::string& name, const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), name) == known.end())
        throw_input_error({}, fmt::format("unknown {} '{}'", what, name),
                          fmt::format("take one of: {}", fmt::join(known, ", ")));
}

/// Without a configuration: OpenColorIO's own displays. They are built from their styles, because
/// OpenColorIO 2.1 has no built-in configurations.
DisplayProcessor builtin_processor(const DisplayOptions& options) {
    const std::string display = options.display.empty() ? "sRGB" : options.display;
    check_name("display", display, builtin_displays());
    if (!options.view.empty())
        check_name("view", options.view, {builtin_view});
    const auto transform = OCIO::BuiltinTransform::Create();
    transform->setStyle((std::string(builtin_prefix) + display).c_str());
    const auto config = OCIO::Config::CreateRaw();
    return {config->getProcessor(transform)->getDefaultCPUProcessor(), display == "sRGB"};
}

std::vector<std::string> displays_of(const OCIO::Config& config) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumDisplays(); ++i)
        names.emplace_back(config.getDisplay(i));
    return names;
}

std::vector<std::string> views_of(const OCIO::Config& config, const std::string& display) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
        names.emplace_back(config.getView(display.c_str(), i));
    return names;
}

/// Steps from CIE XYZ to a colour space of the configuration, and that space's role. The scene's
/// interchange space comes first: from the display's one no view transform would be applied.
const char* add_path_to_config(const OCIO::Config& config, OCIO::GroupTransform& steps) {
    if (config.hasRole(OCIO::ROLE_INTERCHANGE_SCENE)) {
        const auto to_aces = OCIO::BuiltinTransform::Create();
        to_aces->setStyle("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
        to_aces->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
        steps.appendTransform(to_aces);
        return OCIO::ROLE_INTERCHANGE_SCENE;
    }
    if (config.hasRole(OCIO::ROLE_INTERCHANGE_DISPLAY))
        return OCIO::ROLE_INTERCHANGE_DISPLAY;
    if (!config.hasRole(OCIO::ROLE_SCENE_LINEAR))
        throw_input_error({},
                          "the OpenColorIO configuration has none of the roles "
                          "aces_interchange, cie_xyz_d65_interchange, scene_linear",
                          "add one of them to it");
    logging::warn("the OpenColorIO configuration has no interchange role; its scene_linear space "
                  "is taken to have the Rec. 709 primaries");
    double matrix[16] = {};
    for (std::size_t column = 0; column < 3; ++column) {
        Xyz unit{0.0, 0.0, 0.0};
        unit[column] = 1.0;
        const auto rgb = xyz_to_linear_srgb(unit);
        for (std::size_t row = 0; row < 3; ++row)
            matrix[4 * row + column] = rgb[row];
    }
    matrix[15] = 1.0;
    const auto to_rec709 = OCIO::MatrixTransform::Create();
    to_rec709->setMatrix(matrix);
    steps.appendTransform(to_rec709);
    return OCIO::ROLE_SCENE_LINEAR;
}

DisplayProcessor config_processor(const std::string& name, const DisplayOptions& options) {
    std::error_code ignored;
    if (std::filesystem::exists(name, ignored) && !std::filesystem::is_regular_file(name, ignored))
        throw_input_error({name}, "is no regular file", "give a configuration file");
    const auto config = OCIO::Config::CreateFromFile(name.c_str());
    const std::vector<std::string> displays = displays_of(*config);
    if (displays.empty())
        throw_input_error({name}, "the OpenColorIO configuration has no display",
                          "add one under displays:");
    const std::string display =
        options.display.empty() ? config->getDefaultDisplay() : options.display;
    check_name("display", display, displays);
    const std::string view =
        options.view.empty() ? config->getDefaultView(display.c_str()) : options.view;
    check_name("view", view, views_of(*config, display));

    const auto steps = OCIO::GroupTransform::Create();
    const char* const source = add_path_to_config(*config, *steps);
    const auto to_display = OCIO::DisplayViewTransform::Create();
    to_display->setSrc(source);
    to_display->setDisplay(display.c_str());
    to_display->setView(view.c_str());
    steps->appendTransform(to_display);
    return {config->getProcessor(steps)->getDefaultCPUProcessor(), false};
}

DisplayProcessor display_processor(const DisplayOptions& options) {
    std::string config = options.ocio_config.string();
    const char* const variable = std::getenv("OCIO");
    if (config.empty() && variable)
        config = variable;
    if (config.empty())
        return builtin_processor(options);
    try {
        return config_processor(config, options);
    } catch (const OCIO::Exception& error) {
        throw_input_error({config}, fmt::format("OpenColorIO refuses this: {}", error.what()),
                          "give a configuration file, or unset $OCIO for plain sRGB");
    }
}

/// XYZ after the exposure. No white is adapted: the illuminant D65 on a white surface has the
/// white of the display already, and other light keeps its colour, as it would in a room where
/// the eye is adapted to D65.
std::vector<float> exposed_xyz(const SpectralImage& image, double exposure_ev) {
    const double gain = std::exp2(exposure_ev);
    std::vector<float> result;
    result.reserve(3 * static_cast<std::size_t>(image.width) *
                   static_cast<std::size_t>(image.height));
    for (const Xyz& xyz : xyz_image(image))
        for (const double value : xyz)
            result.push_back(static_cast<float>(gain * value));
    return result;
}

/// 8 bit codes of display values 0 to 1. `out_of_gamut` counts the pixels where clipping, beyond
/// rounding, changes a channel (brighter than white counts too), or that are not finite.
std::vector<std::uint8_t> quantise(const std::vector<float>& display, std::size_t& out_of_gamut) {
    std::vector<std::uint8_t> codes(display.size());
    out_of_gamut = 0;
    for (std::size_t pixel = 0; pixel < display.size(); pixel += 3) {
        bool outside = false;
        for (std::size_t i = pixel; i < pixel + 3; ++i) {
            const float code = 255.0f * display[i];
            const bool fits = code > -0.5f && code < 255.5f; // false for NaN
            outside = outside || !fits;
            const float clipped = std::isnan(code) ? 0.0f : std::clamp(code, 0.0f, 255.0f);
            codes[i] = static_cast<std::uint8_t>(std::lround(clipped));
        }
        out_of_gamut += outside ? 1 : 0;
    }
    return codes;
}

} // namespace

void check_exposure(double exposure_ev) {
    constexpr double most_ev = 100.0;
    if (!(std::abs(exposure_ev) <= most_ev))
        throw_input_error({}, fmt::format("--exposure is {}", exposure_ev),
                          fmt::format("it must be from {} to {}", -most_ev, most_ev));
}

void check_display(const DisplayOptions& options) {
    display_processor(options);
}

DisplayPicture display_picture(const SpectralImage& image, const DisplayOptions& options) {
    const DisplayProcessor display = display_processor(options);
    std::vector<float> pixels = exposed_xyz(image, options.exposure_ev);
    OCIO::PackedImageDesc description(pixels.data(), image.width, image.height, 3);
    display.processor->apply(description);
    DisplayPicture picture;
    picture.is_srgb = display.is_srgb;
    picture.rgb = quantise(pixels, picture.out_of_gamut);
    return picture;
}

std::size_t write_display_png(const std::filesystem::path& file, const SpectralImage& image,
                              const DisplayOptions& options) {
    const DisplayPicture picture = display_picture(image, options);
    write_png(file, image.width, image.height, picture.rgb, picture.is_srgb);
    return picture.out_of_gamut;
}

} // namespace reradiant
