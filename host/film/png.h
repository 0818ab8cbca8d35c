#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace reradiant {

/// Writes 8 bit RGB, (height, width, 3), atomically. `is_srgb` marks the file as sRGB.
void write_png(const std::filesystem::path& file, int width, int height,
               const std::vector<std::uint8_t>& rgb, bool is_srgb);

} // namespace reradiant
