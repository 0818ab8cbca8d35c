#pragma once

#include <filesystem>
#include <vector>

namespace reradiant {

/// Remembers a file that a scene, material or recipe names. May be called by several threads.
void remember_named_file(const std::filesystem::path& file);

/// The files that were remembered in this process, in no order: what an output must not replace.
std::vector<std::filesystem::path> named_files();

} // namespace reradiant
