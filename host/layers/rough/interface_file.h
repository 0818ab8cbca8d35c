#pragma once

#include "host/layers/rough/interface_walk.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace reradiant {

/// What the disk cache keeps of rough interfaces.
enum class InterfaceNumbers { Operator, FacetShape, LobeRatio };

/// An `InterfaceKey` says which interface a file belongs to, whose IOR ratio is eta_1e4 / 10000
/// whatever `interface` says, and what of it the file holds. What depends on several interfaces has
/// all that it depends on in `numbers` instead.
struct InterfaceKey {
    InterfaceNumbers kind;
    RoughInterface interface;
    long eta_1e4;
    std::vector<double> numbers = {};

    /// The file's path within cache_directory().
    std::filesystem::path file() const;
};

/// Returns the numbers of a file, or nothing when there is no such file. Also returns nothing, with
/// a warning, for a file that is damaged, that belongs to another key or version, or that does not
/// hold so many numbers.
std::optional<std::vector<double>> read_interface_file(const std::filesystem::path& file,
                                                       const InterfaceKey& key, std::size_t count);

/// Writes numbers with their checksum, atomically; run-time Error when that fails.
void write_interface_file(const std::filesystem::path& file, const InterfaceKey& key,
                          const std::vector<double>& numbers);

/// Writes numbers to the key's own file. A cache that cannot be written is no error: it only costs
/// time.
void keep_interface_numbers(const InterfaceKey& key, const std::vector<double>& numbers);

} // namespace reradiant
