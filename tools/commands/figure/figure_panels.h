#pragma once

#include "tools/commands/figure/figure_request.h"

#include <vector>

namespace reradiant {

/// A mark of an image that was read: what is seen there, and the colour in which it is shown.
struct ReadMark {
    RegionValues values;
    std::array<std::uint8_t, 3> rgb{};
};

/// An image that was read and developed.
struct ReadImage {
    Picture picture; ///< the whole image
    WavelengthGrid bands;
    std::vector<ReadMark> marks;
};

/// Reads and develops the images of a figure, one after another. Input Error at the key of an image
/// that is no spectral image, and at a mark or crop that reaches outside its image.
std::vector<ReadImage> read_images(const FigureRequest& request);

/// The panels that a figure asks for, row by row.
Figure figure_of(const FigureRequest& request, const std::vector<ReadImage>& images);

} // namespace reradiant
