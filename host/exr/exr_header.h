#pragma once

#include <filesystem>

namespace reradiant {

/// Walks through the headers of an EXR file without OpenEXR, which takes the memory that they claim
/// before it looks how much the file holds (up to 2 GB for an attribute of a file of 400 bytes,
/// more for rows and tiles of many channels). Input Error for no EXR file, for an attribute that
/// ends beyond the file, for more pixels than the file can stand for, however well it is packed,
/// and for rows or tiles of more than 256 MB in a smaller image.
void check_exr_header(const std::filesystem::path& file);

} // namespace reradiant
