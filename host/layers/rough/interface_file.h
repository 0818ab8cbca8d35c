#pragma once

#include "host/layers/rough/interface_operator.h"

#include <filesystem>
#include <optional>

namespace reradiant {

/// Returns the file in which the disk cache keeps the operator of an interface, whose IOR ratio is
/// eta_1e4 / 10000.
std::filesystem::path interface_file(const RoughInterface& interface, long eta_1e4);

/// Returns the operator that a file holds, or nothing when there is no such file. Also returns
/// nothing, with a warning, for a file that is damaged or belongs to another interface or version.
std::optional<InterfaceOperator> read_interface_file(const std::filesystem::path& file,
                                                     const RoughInterface& interface, long eta_1e4);

/// Writes an operator with its checksum, atomically; run-time Error when that fails.
void write_interface_file(const std::filesystem::path& file, const InterfaceOperator& op,
                          long eta_1e4);

} // namespace reradiant
