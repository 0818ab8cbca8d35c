#pragma once

#include "host/layers/rough/interface_operator.h"

#include <filesystem>
#include <optional>

namespace reradiant {

/// Where the disk cache keeps the operator of an interface, whose IOR ratio is eta_1e4 / 10000.
std::filesystem::path interface_file(const RoughInterface& interface, long eta_1e4);

/// The operator that a file holds; nothing when there is no such file. One that is damaged, or of
/// another interface or version, is nothing too, and a warning says so.
std::optional<InterfaceOperator> read_interface_file(const std::filesystem::path& file,
                                                     const RoughInterface& interface, long eta_1e4);

/// Writes an operator with its checksum, atomically; run-time Error when that fails.
void write_interface_file(const std::filesystem::path& file, const InterfaceOperator& op,
                          long eta_1e4);

} // namespace reradiant
