#include "host/layers/sources/depth_cells.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

int DepthCells::doublings(int cell) const {
    const int from_face = std::min(cell, count() - 1 - cell);
    return std::max(from_face / cells_per_octave - 1, 0);
}

double DepthCells::share(int cell) const {
    // the octaves of one half add up to 2^(octaves - 1) times the first
    return std::ldexp(1.0, doublings(cell) - octaves) / cells_per_octave;
}

DepthCells depth_cells(double largest_depth, int cells_per_octave) {
    constexpr int least = 2, most = 16;
    // half a slab is 2^(octaves - 1) first octaves
    const double first_octaves = std::max(largest_depth, 1e-300);
    const int octaves = 1 + static_cast<int>(std::ceil(std::log2(first_octaves)));
    return {std::clamp(octaves, least, most), cells_per_octave};
}

} // namespace reradiant
