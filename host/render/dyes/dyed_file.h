#pragma once

#include "host/render/dyes/dyed_operator.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace reradiant {

/// Folder within cache_directory() that keeps the operators of dyed materials.
std::filesystem::path dyed_folder();

/// Most bytes that the folder's files take together; those used longest ago are removed.
inline constexpr std::uintmax_t most_dyed_bytes = std::uintmax_t{1} << 30;

/// Returns the operator of a key, 64 hex digits, bit for bit as it was kept, or nothing where none
/// is. Also returns nothing, with a warning, for a file that is damaged or holds another key's.
/// Thread-safe.
std::optional<DyedOperator> read_dyed_file(const std::string& key);

/// Keeps an operator under a key: atomically, and not where it would take more than a quarter of
/// the folder. A cache that cannot be written is no error: it only costs time. Thread-safe.
void keep_dyed_operator(const std::string& key, const DyedOperator& dyes,
                        std::uintmax_t most_bytes = most_dyed_bytes);

} // namespace reradiant
