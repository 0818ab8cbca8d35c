#pragma once

#include "host/film/spectral_image.h"

#include <cstdint>

namespace reradiant {

/// 8 bit display values, (height, width, 3), through OpenColorIO: what write_display_png writes.
struct DisplayPicture {
    std::vector<std::uint8_t> rgb;
    bool is_srgb = false;
    std::size_t out_of_gamut = 0; ///< pixels that the display cannot show
};
DisplayPicture display_picture(const SpectralImage& image, const DisplayOptions& options);

} // namespace reradiant
