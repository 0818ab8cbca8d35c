#pragma once

#include <filesystem>
#include <fstream>

namespace reradiant {

/// A stream on a regular file, or one that failed: a pipe would wait for a writer, a device may
/// never end, and a folder opens but does not read.
inline std::ifstream open_regular_file(const std::filesystem::path& file) {
    std::error_code ignored;
    std::ifstream stream;
    if (std::filesystem::is_regular_file(file, ignored))
        stream.open(file, std::ios::binary);
    else
        stream.setstate(std::ios::failbit);
    return stream;
}

} // namespace reradiant
