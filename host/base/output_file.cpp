#include "host/base/output_file.h"

#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr int most_links = 40; // as Linux follows
constexpr std::size_t longest_name = 255;

/// /dev/stdout, /dev/fd/1 and so on end as a link of a folder /proc/PROCESS/fd. What such a link
/// names may be a file with content of its own (`>> log`), which must not be replaced.
bool is_open_descriptor(const fs::path& link) {
    std::error_code ignored;
    const fs::path folder =
        fs::canonical(link.has_parent_path() ? link.parent_path() : ".", ignored);
    return folder.filename() == "fd" && folder.string().starts_with("/proc/");
}

/// Returns the errno that keeps new files out of the folder; 0 where it takes them, or has no room
/// for them now.
int why_not_writable(const fs::path& temporary) {
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600);
    if (descriptor < 0)
        return errno == ENOSPC || errno == EDQUOT || errno == EEXIST ? 0 : errno;
    ::close(descriptor);
    ::unlink(temporary.c_str());
    return 0;
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Throws an input Error at `named` unless `file` can be made, or replaced, where it is.
void check_place(const fs::path& named, const fs::path& file) {
    const SourcePosition position{named.string()};
    const fs::path folder = folder_of(file);
    std::error_code ignored;
    if (!fs::exists(folder, ignored))
        throw_input_error(position, fmt::format("the folder {} does not exist", folder.string()),
                          "make it first, or write elsewhere");
    if (!fs::is_directory(folder, ignored))
        throw_input_error(position, fmt::format("{} is a file, not a folder", folder.string()),
                          "write elsewhere");
    if (file.filename().string().size() > longest_name)
        throw_input_error(position, "the name is too long", "take a shorter one");
    if (const int code = why_not_writable(temporary_beside(file)))
        throw_input_error(position,
                          fmt::format("the folder {} cannot be written to: {}", folder.string(),
                                      std::strerror(code)),
                          "change its permissions, or write elsewhere");
}

} // namespace

OutputFile output_file(const fs::path& named) {
    const SourcePosition position{named.string()};
    std::error_code ignored;
    fs::path file = named;
    bool is_stream = false;
    for (int links = 0; !is_stream && fs::is_symlink(file, ignored); ++links) {
        if (links == most_links)
            throw_input_error(position, "symbolic links lead round in a circle here",
                              "write to another name");
        is_stream = is_open_descriptor(file);
        if (!is_stream) {
            const fs::path target = fs::read_symlink(file, ignored);
            file = target.is_absolute() ? target : file.parent_path() / target;
        }
    }
    const fs::file_status status = fs::status(file, ignored);
    if (fs::is_directory(status) || !file.has_filename())
        throw_input_error(position, "is a folder, not a file", "give the name of a file");
    if (fs::is_socket(status) || fs::is_block_file(status))
        throw_input_error(position, fs::is_socket(status) ? "is a socket" : "is a disk",
                          "give the name of a file");
    is_stream = is_stream || fs::is_fifo(status) || fs::is_character_file(status);
    return {file, is_stream};
}

fs::path temporary_beside(const fs::path& file) {
    const std::string ending = fmt::format(".{}.partial{}", ::getpid(), file.extension().string());
    // The name is longer than that of the file, which may be as long as names can be.
    const std::size_t most = longest_name - std::min(longest_name, ending.size() + 1);
    fs::path temporary = file;
    temporary.replace_filename(fmt::format(".{}{}", file.stem().string().substr(0, most), ending));
    return temporary;
}

void check_output_file(const fs::path& named) {
    const OutputFile output = output_file(named);
    std::error_code ignored;
    if (fs::exists(output.file, ignored) && ::access(output.file.c_str(), W_OK) != 0)
        throw_input_error({named.string()},
                          fmt::format("cannot be written: {}", std::strerror(errno)),
                          "change its permissions, or write elsewhere");
    if (!output.is_stream)
        check_place(named, output.file);
}

void check_output_folder(const fs::path& named) {
    const fs::path folder = named.has_filename() ? named : named.parent_path();
    std::error_code ignored;
    const fs::file_status status = fs::status(folder, ignored);
    if (fs::is_directory(status))
        return check_place(named, folder / "index.html");
    if (fs::exists(status))
        throw_input_error({named.string()}, "is a file, not a folder", "give the name of a folder");
    if (fs::is_symlink(fs::symlink_status(folder, ignored)))
        throw_input_error({named.string()}, "is a symbolic link that leads to no folder",
                          "make the folder first, or write elsewhere");
    check_place(named, folder);
}

} // namespace reradiant
