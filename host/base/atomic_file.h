#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace reradiant {

/// Writes a file so that a reader sees the old content or the new, never a part: `write` gets
/// the name of a temporary file in the same folder (same ending), which is then synced to disk
/// and renamed. When anything fails the temporary file is removed, the old file stays and a
/// run-time Error that names the file is thrown.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes a text that is ready to a file, as write_atomically does.
void write_text_atomically(const std::filesystem::path& file, const std::string& text);

} // namespace reradiant
