#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace reradiant {

/// Writes 8 bit sRGB, (height, width, 3), atomically, as a TIFF with LZW compression, which every
/// reader knows. Run-time Error for what libtiff refuses.
void write_tiff(const std::filesystem::path& file, int width, int height,
                const std::vector<std::uint8_t>& rgb);

} // namespace reradiant
