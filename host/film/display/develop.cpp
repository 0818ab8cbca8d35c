#include "host/film/display/develop.h"

#include "host/base/logging.h"
#include "host/base/output_ending.h"
#include "host/film/colour_image.h"
#include "host/film/display/display_gamut.h"
#include "host/film/display/display_picture.h"
#include "host/film/display/display_processor.h"
#include "host/film/display/jpeg.h"
#include "host/film/display/picture_levels.h"
#include "host/film/display/png.h"
#include "host/film/display/tiff.h"
#include "host/spectral/colour/bradford.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace OCIO = OCIO_NAMESPACE;

namespace reradiant {

namespace {

/// XYZ of luminance 1.
Xyz white_of(const std::array<double, 2>& xy) {
    return {xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]};
}

/// Returns whether an eye could be adapted to light of this chromaticity.
bool is_white(const std::array<double, 2>& xy) {
    if (!(xy[0] > 0.0 && xy[1] > 0.0 && xy[0] + xy[1] < 1.0))
        return false;
    const auto cones = bradford_cones(white_of(xy));
    return cones[0] > 0.0 && cones[1] > 0.0 && cones[2] > 0.0;
}

void check_white(const std::array<double, 2>& xy) {
    if (!is_white(xy))
        throw_input_error({},
                          fmt::format("--white: x = {:.4g}, y = {:.4g} is no white that an eye "
                                      "adapts to",
                                      xy[0], xy[1]),
                          "take a less saturated light; D65 is 0.3127,0.3290");
}

/// The white to adapt; empty: none. What the image shows is no mistake of the user's, so that a
/// median colour that is no white is only warned of.
std::optional<std::array<double, 2>> white_of(const std::vector<Xyz>& pixels,
                                              const DevelopOptions& options) {
    if (!options.auto_white)
        return options.white_xy;
    const auto median = median_chromaticity(pixels);
    if (!median || is_white(*median))
        return median;
    logging::warn("--white auto: the median colour of the image (x = {:.4g}, y = {:.4g}) is too "
                  "saturated for a white; nothing is adapted",
                  (*median)[0], (*median)[1]);
    return std::nullopt;
}

/// Adaptation from a white to D65, that of linear sRGB. Without a white nothing is adapted: the
/// illuminant D65 on a white surface has the display's white already, and other light keeps its
/// colour, as it would in a room where the eye is adapted to D65.
void adapt(std::vector<Xyz>& pixels, const std::array<double, 2>& white_xy) {
    const Xyz from = white_of(white_xy), d65 = linear_srgb_to_xyz({1.0, 1.0, 1.0});
    std::array<Xyz, 3> columns;
    for (std::size_t k = 0; k < 3; ++k) {
        Xyz unit{0.0, 0.0, 0.0};
        unit[k] = 1.0;
        columns[k] = adapt_white(unit, from, d65);
    }
    for (Xyz& xyz : pixels) {
        const Xyz before = xyz;
        for (std::size_t row = 0; row < 3; ++row)
            xyz[row] = columns[0][row] * before[0] + columns[1][row] * before[1] +
                       columns[2][row] * before[2];
    }
}

std::vector<float> displayed(const std::vector<Xyz>& pixels, const SpectralImage& image,
                             const DisplayProcessor& display) {
    std::vector<float> values;
    values.reserve(3 * pixels.size());
    for (const Xyz& xyz : pixels)
        for (const double value : xyz)
            values.push_back(static_cast<float>(value));
    OCIO::PackedImageDesc description(values.data(), image.width, image.height, 3);
    display.processor->apply(description);
    return values;
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

DisplayProcessor checked_processor(const DevelopOptions& options) {
    if (!options.auto_exposure)
        check_exposure(options.display.exposure_ev);
    if (options.white_xy && !options.auto_white)
        check_white(*options.white_xy);
    DisplayProcessor display = display_processor(options.display);
    if (options.gamut == Gamut::Compress && !display.xyz_of_primaries)
        throw_input_error({},
                          "--gamut compress is for the built-in displays; the views of an "
                          "OpenColorIO configuration map their gamut themselves",
                          "leave --gamut away, or --ocio and $OCIO");
    return display;
}

} // namespace

void check_develop(const DevelopOptions& options) {
    checked_processor(options);
}

Picture develop(const SpectralImage& image, const DevelopOptions& options) {
    const DisplayProcessor display = checked_processor(options);
    std::vector<Xyz> pixels = xyz_image(image);
    Picture picture;
    picture.width = image.width;
    picture.height = image.height;
    picture.encoding = display.encoding;
    picture.white_xy = white_of(pixels, options);
    if (picture.white_xy)
        adapt(pixels, *picture.white_xy);
    picture.exposure_ev =
        options.auto_exposure ? exposure_of_level(body_level(pixels)) : options.display.exposure_ev;
    const double gain = std::exp2(picture.exposure_ev);
    for (Xyz& xyz : pixels)
        for (double& value : xyz)
            value *= gain;
    picture.rgb = quantise(displayed(pixels, image, display), picture.out_of_gamut);
    if (options.gamut == Gamut::Compress) {
        const DisplayGamut gamut(*display.xyz_of_primaries);
        for (Xyz& xyz : pixels)
            xyz = gamut.compressed(xyz);
        std::size_t still_outside = 0; // what is not finite
        picture.rgb = quantise(displayed(pixels, image, display), still_outside);
    }
    return picture;
}

void write_picture(const std::filesystem::path& file, const Picture& picture) {
    const std::string ending = lower_case_ending(file);
    const bool is_tiff = ending == ".tif" || ending == ".tiff";
    if (ending != ".jpg" && ending != ".jpeg" && !is_tiff) {
        write_png(file, picture.width, picture.height, picture.rgb, picture.encoding);
        return;
    }
    if (!picture.encoding.is_srgb)
        throw_input_error({file.string()},
                          fmt::format("a {} says nothing of its colours, so that readers take "
                                      "them for sRGB",
                                      is_tiff ? "TIFF" : "JPEG"),
                          "name a .png here, or leave the display to sRGB");
    (is_tiff ? write_tiff : write_jpeg)(file, picture.width, picture.height, picture.rgb);
}

} // namespace reradiant
