#pragma once

#include <filesystem>
#include <string>

namespace reradiant {

/// The file of a program in the disk cache.
std::filesystem::path cached_program_file(const std::string& key);

/// The binary that a file of the cache holds; empty when there is no such file, or one that is
/// damaged, of another version, or larger than any program: a driver that loads a damaged binary
/// may take the process with it.
std::string read_cached_program(const std::filesystem::path& file);

/// Writes a binary with its checksum, atomically; run-time Error when that fails.
void write_cached_program(const std::filesystem::path& file, const std::string& binary);

} // namespace reradiant
