#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace reradiant {

/// Writes 8 bit sRGB, (height, width, 3), atomically, as a JPEG of quality 95 with colours at full
/// resolution. Input Error for a side above 65,500 pixels, which is libjpeg's limit.
void write_jpeg(const std::filesystem::path& file, int width, int height,
                const std::vector<std::uint8_t>& rgb);

} // namespace reradiant
