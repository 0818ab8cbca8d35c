#pragma once

#include <filesystem>

namespace reradiant {

/// An `OutputFile` says where the bytes that are written under a name end up.
struct OutputFile {
    std::filesystem::path file; ///< what symbolic links lead to; it need not exist
    /// A device, a pipe or an open descriptor such as /dev/stdout: bytes are sent there, and it is
    /// never replaced by another file.
    bool is_stream = false;
};

/// Follows the symbolic links of a name, also over the last one to a file that does not exist yet.
/// Input Error for what no file can be written to: a folder, a socket, a disk, or links that lead
/// round in a circle.
OutputFile output_file(const std::filesystem::path& named);

/// Name of a file beside `file`, with the same ending, that this process may write first and then
/// rename to it.
std::filesystem::path temporary_beside(const std::filesystem::path& file);

/// Refuses, by an input Error at the name, what could not be written later: as output_file, and
/// where the folder is not there, or it or a file that exists cannot be written. Leaves nothing
/// behind. What a disk has no room for is not refused: there may be room by then.
void check_output_file(const std::filesystem::path& named);

/// Refuses a folder into which files could not be written later, as check_output_file does a file.
/// A folder that does not exist passes when the folder around it exists: it is made later.
void check_output_folder(const std::filesystem::path& named);

} // namespace reradiant
