#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace reradiant {

/// Throws an input Error naming the image when comparing two would take more memory than the limit
/// (0: 80 % of the machine's). Only headers are read. A file that is no spectral image is left to
/// read_spectral_exr.
void check_compare_memory(const std::filesystem::path& image,
                          const std::filesystem::path& reference, std::uint64_t limit_bytes);
/// Throws an input Error naming a part when merge_images would take more memory than the limit.
void check_merge_memory(const std::vector<std::filesystem::path>& parts, std::uint64_t limit_bytes);

} // namespace reradiant
