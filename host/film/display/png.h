#pragma once

#include "host/film/display/develop.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// A PNG file of 8 bit RGB, (height, width, 3), that says what its codes stand for: an sRGB
/// chunk, or a cICP chunk (PNG, third edition) where ITU-T H.273 has the display's curve, and cHRM
/// and gAMA chunks where that curve is a power, for readers that know no cICP. Run-time Error for
/// what libpng refuses.
std::string png_bytes(int width, int height, const std::vector<std::uint8_t>& rgb,
                      const PictureEncoding& encoding);

/// Writes that file, atomically.
void write_png(const std::filesystem::path& file, int width, int height,
               const std::vector<std::uint8_t>& rgb, const PictureEncoding& encoding);

/// The same for an image that is sRGB, or of which nothing is known.
void write_png(const std::filesystem::path& file, int width, int height,
               const std::vector<std::uint8_t>& rgb, bool is_srgb);

} // namespace reradiant
