#pragma once

#include "reradiant/spectral_image.h"

#include <cstdint>

namespace reradiant {

/// Input Error for a configuration, display or view that no image can be shown through, with the
/// names that there are.
void check_display(const DisplayOptions& options);
/// Input Error for an exposure that is no number or beyond 100 EV to either side.
void check_exposure(double exposure_ev);

/// 8 bit display values, (height, width, 3), through OpenColorIO: what write_display_png writes.
struct DisplayPicture {
    std::vector<std::uint8_t> rgb;
    bool is_srgb = false;
    std::size_t out_of_gamut = 0; ///< pixels that the display cannot show
};
DisplayPicture display_picture(const SpectralImage& image, const DisplayOptions& options);

} // namespace reradiant
