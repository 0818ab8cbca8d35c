#pragma once

#include "host/exr/exr_header.h"

#include <ImfHeader.h>

namespace reradiant {

/// What every reader of EXR files does first: headers that claim more than the file can hold
/// are refused (check_exr_header), and sizes beyond a film's 65536 will be, as OpenEXR reads the
/// header and before it takes memory for tables of rows and tiles.
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
