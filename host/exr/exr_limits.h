#pragma once

#include "host/exr/exr_header.h"

#include <ImfHeader.h>

namespace reradiant {

/// Does what every reader of EXR files does first. It refuses headers that claim more than the file
/// can hold (check_exr_header), and has OpenEXR refuse sizes beyond a film's 65536, and tiles
/// beyond 4096, as it reads the header and before it takes memory for tables of rows and tiles.
inline void refuse_hostile_exr(const std::filesystem::path& file) {
    constexpr int largest_side = 65536, largest_tile_side = 4096;
    [[maybe_unused]] static const bool limits_set = [] {
        Imf::Header::setMaxImageSize(largest_side, largest_side);
        Imf::Header::setMaxTileSize(largest_tile_side, largest_tile_side);
        return true;
    }();
    check_exr_header(file);
}

} // namespace reradiant
