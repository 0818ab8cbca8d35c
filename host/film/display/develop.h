#pragma once

#include "reradiant/spectral_image.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace reradiant {

/// What happens to colours that a display cannot show. `Clip` cuts every channel off by itself,
/// which moves hues. `Compress` takes them towards the neutral axis at their own hue, the further
/// the more they are outside, so that differences between them stay; see
/// host/film/display/display_gamut.h.
enum class Gamut { Clip, Compress };

/// `DevelopOptions` say how a spectral image becomes a picture.
struct DevelopOptions {
    DisplayOptions display;
    /// The exposure is chosen by the image, and `display.exposure_ev` is not read: 0 EV where the
    /// median body (largest channel of linear sRGB, over pixels that are not black) lies between a
    /// tenth and 0.9 of white, else what shows it at 0.6 of white.
    bool auto_exposure = false;
    /// CIE 1931 x and y of the light that becomes the display's white, by Bradford adaptation;
    /// empty: that of D65, and nothing is adapted.
    std::optional<std::array<double, 2>> white_xy = {};
    /// The white is the median colour of the image, and `white_xy` is not read: of what has a
    /// luminance from a twentieth of the 99th percentile up to it, so that neither shadows nor
    /// lamps and highlights count, nor saturated bodies that cover less than half of the rest. A
    /// median that is no white is warned of, and nothing is adapted.
    bool auto_white = false;
    Gamut gamut = Gamut::Clip;
};

/// What the codes of a picture stand for, as far as it is known; see host/film/display/png.h.
struct PictureEncoding {
    bool is_srgb = false;
    /// x and y of white, red, green and blue; empty where a configuration made the picture.
    std::optional<std::array<std::array<double, 2>, 4>> primaries_xy = {};
    double gamma = 0.0; ///< exponent from codes to light; 0: the curve is no plain power
    /// ColourPrimaries and TransferCharacteristics of ITU-T H.273; 0: none of these.
    std::uint8_t cicp_primaries = 0, cicp_transfer = 0;
};

/// A developed picture: 8 bit display values, (height, width, 3).
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
    PictureEncoding encoding;
    std::size_t out_of_gamut = 0; ///< pixels whose colour the display cannot show, before `gamut`
    double exposure_ev = 0.0;     ///< that was taken
    std::optional<std::array<double, 2>> white_xy = {}; ///< that was adapted; empty: none
};

/// Develops an image. Input Error for a configuration, display or view that there is not, for
/// `Compress` with a configuration (whose views map their gamut themselves), for an exposure beyond
/// 100 EV, and for a white that no eye adapts to (x, y or one of Bradford's cones is not above 0).
Picture develop(const SpectralImage& image, const DevelopOptions& options);

/// Refuses, before there is an image, what `develop` would refuse.
void check_develop(const DevelopOptions& options);

/// Writes a picture: a JPEG where the file's ending is .jpg or .jpeg, a TIFF where it is .tif or
/// .tiff, both for sRGB displays alone (input Error else), a PNG otherwise. Atomic.
void write_picture(const std::filesystem::path& file, const Picture& picture);

} // namespace reradiant
