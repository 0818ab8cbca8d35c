#include "host/film/display/display_processor.h"

#include "host/base/logging.h"
#include "reradiant/colour.h"
#include "reradiant/error.h"

#include <Eigen/LU>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

namespace OCIO = OCIO_NAMESPACE;

namespace reradiant {

namespace {

constexpr std::string_view builtin_prefix = "DISPLAY - CIE-XYZ-D65_to_";
constexpr const char* builtin_view = "Standard";

/// What a picture file can say of a display's curve and primaries.
struct KnownDisplay {
    std::string_view name;
    double gamma; ///< 0: no plain power
    std::uint8_t cicp_primaries, cicp_transfer;
};

/// By ITU-T H.273, tables 2 and 3; a transfer of 0 is a curve that it does not have (a power of 2.4
/// or 2.6). Displays whose white is adapted (BFD) have primaries of their own.
constexpr std::array known_displays = {KnownDisplay{"sRGB", 0.0, 1, 13},
                                       KnownDisplay{"REC.1886-REC.709", 2.4, 0, 0},
                                       KnownDisplay{"REC.1886-REC.2020", 2.4, 0, 0},
                                       KnownDisplay{"G2.2-REC.709", 2.2, 1, 4},
                                       KnownDisplay{"G2.6-P3-DCI-BFD", 2.6, 0, 0},
                                       KnownDisplay{"G2.6-P3-D65", 2.6, 0, 0},
                                       KnownDisplay{"G2.6-P3-D60-BFD", 2.6, 0, 0},
                                       KnownDisplay{"DisplayP3", 0.0, 12, 13},
                                       KnownDisplay{"REC.2100-PQ", 0.0, 9, 16},
                                       KnownDisplay{"ST2084-P3-D65", 0.0, 12, 16},
                                       KnownDisplay{"REC.2100-HLG-1000nit", 0.0, 9, 18}};

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

OCIO::ConstCPUProcessorRcPtr builtin_transform(const std::string& display,
                                               OCIO::TransformDirection direction) {
    const auto transform = OCIO::BuiltinTransform::Create();
    transform->setStyle((std::string(builtin_prefix) + display).c_str());
    transform->setDirection(direction);
    return OCIO::Config::CreateRaw()->getProcessor(transform)->getDefaultCPUProcessor();
}

/// The chromaticities are those of the display's own codes. The amounts come from its white, since
/// a curve such as HLG's depends on all three channels together.
Eigen::Matrix3d primaries_of(const std::string& display) {
    const auto to_xyz = builtin_transform(display, OCIO::TRANSFORM_DIR_INVERSE);
    const auto xyz_of_codes = [&](float red, float green, float blue) {
        float values[3] = {red, green, blue};
        to_xyz->applyRGB(values);
        return Eigen::Vector3d(values[0], values[1], values[2]);
    };
    Eigen::Matrix3d directions;
    directions << xyz_of_codes(1, 0, 0), xyz_of_codes(0, 1, 0), xyz_of_codes(0, 0, 1);
    const Eigen::Vector3d amounts = directions.inverse() * xyz_of_codes(1, 1, 1);
    return directions * amounts.asDiagonal();
}

std::array<double, 2> chromaticity(const Eigen::Vector3d& xyz) {
    return {xyz[0] / xyz.sum(), xyz[1] / xyz.sum()};
}

PictureEncoding encoding_of(const std::string& display, const Eigen::Matrix3d& primaries) {
    PictureEncoding encoding;
    encoding.is_srgb = display == "sRGB";
    encoding.primaries_xy = {chromaticity(primaries.rowwise().sum()),
                             chromaticity(primaries.col(0)), chromaticity(primaries.col(1)),
                             chromaticity(primaries.col(2))};
    for (const KnownDisplay& known : known_displays)
        if (known.name == display) {
            encoding.gamma = known.gamma;
            encoding.cicp_primaries = known.cicp_primaries;
            encoding.cicp_transfer = known.cicp_transfer;
        }
    return encoding;
}

/// Without a configuration: OpenColorIO's own displays. They are built from their styles, because
/// OpenColorIO 2.1 has no built-in configurations.
DisplayProcessor builtin_processor(const DisplayOptions& options) {
    const std::string display = options.display.empty() ? "sRGB" : options.display;
    check_name("display", display, builtin_displays());
    if (!options.view.empty())
        check_name("view", options.view, {builtin_view});
    const Eigen::Matrix3d primaries = primaries_of(display);
    return {builtin_transform(display, OCIO::TRANSFORM_DIR_FORWARD),
            encoding_of(display, primaries), primaries};
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

/// `ocio://default` and its like are configurations inside the library.
void check_builtin_configuration(const std::string& name) {
    constexpr int first_version_with_them = 0x02020000;
    if (name.starts_with("ocio://") && OCIO::GetVersionHex() < first_version_with_them)
        throw_input_error({name},
                          fmt::format("built-in configurations came with OpenColorIO 2.2, and this "
                                      "is {}",
                                      OCIO::GetVersion()),
                          "give a configuration file, or leave it away for the built-in displays");
}

DisplayProcessor config_processor(const std::string& name, const DisplayOptions& options) {
    check_builtin_configuration(name);
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
    return {config->getProcessor(steps)->getDefaultCPUProcessor(), {}, {}};
}

} // namespace

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

} // namespace reradiant
