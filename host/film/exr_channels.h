#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// Names of the channels in all parts of an EXR file; no pixel is read. Input Error for a
/// file that cannot be opened or is no EXR file.
std::vector<std::string> exr_channel_names(const std::filesystem::path& file);

} // namespace reradiant
