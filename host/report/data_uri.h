#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace reradiant {

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// "data:image/png;base64,..." of a PNG file, so that a page needs no other file. Run-time Error
/// when it cannot be read.
std::string png_data_uri(const std::filesystem::path& file);

} // namespace reradiant
