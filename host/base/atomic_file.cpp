#include "host/base/atomic_file.h"

#include "host/base/logging.h"
#include "host/base/output_file.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"

#include <fmt/core.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <sys/stat.h>
#include <unistd.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void throw_errno() {
    throw_runtime_error(std::strerror(errno));
}

/// A descriptor that is closed on the way out.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {
        if (number < 0)
            throw_errno();
    }
    ~Descriptor() { ::close(number_); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number() const { return number_; }

private:
    int number_;
};

void sync_to_disk(const fs::path& file) {
    const Descriptor descriptor(::open(file.c_str(), O_RDWR));
    if (::fsync(descriptor.number()) != 0)
        throw_runtime_error(fmt::format("{}: {}", file.string(), std::strerror(errno)));
}

/// Gives the new file the owner, group and permissions of the one that it takes the place of.
void keep_permissions(const fs::path& old_file, const fs::path& new_file) {
    struct stat old_status {
    }, new_status{};
    if (::stat(old_file.c_str(), &old_status) != 0 || ::stat(new_file.c_str(), &new_status) != 0)
        return; // there is no old file
    // Whom a user cannot give files to, they were not shared with either.
    if (old_status.st_uid != new_status.st_uid || old_status.st_gid != new_status.st_gid)
        std::ignore = ::chown(new_file.c_str(), old_status.st_uid, old_status.st_gid);
    if (::chmod(new_file.c_str(), old_status.st_mode & 07777u) != 0)
        throw_errno();
}

/// A descriptor of this process keeps its place in the file, which a second one would not have.
int open_stream(const fs::path& stream) {
    std::error_code ignored;
    const std::string name = stream.filename().string();
    int number = -1;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool is_number = failure == std::errc{} && end == name.data() + name.size();
    if (is_number && fs::equivalent(stream.parent_path(), "/proc/self/fd", ignored))
        return ::dup(number);
    const int opened = ::open(stream.c_str(), O_WRONLY | O_NONBLOCK);
    if (opened >= 0)
        ::fcntl(opened, F_SETFL, O_WRONLY); // what is written waits until it is read
    if (opened >= 0 || errno != ENXIO)
        return opened;
    logging::warn("{}: nobody reads this pipe yet; waiting for a reader", stream.string());
    return ::open(stream.c_str(), O_WRONLY);
}

void copy_into_stream(const fs::path& file, const fs::path& stream) {
    std::fflush(stdout); // what was printed before comes before
    const Descriptor in(::open(file.c_str(), O_RDONLY)), out(open_stream(stream));
    std::array<char, 1 << 16> bytes;
    ssize_t count = 0;
    while ((count = ::read(in.number(), bytes.data(), bytes.size())) > 0)
        for (ssize_t sent = 0; sent < count;) {
            const ssize_t now =
                ::write(out.number(), bytes.data() + sent, static_cast<std::size_t>(count - sent));
            if (now < 0)
                throw_errno();
            sent += now;
        }
    if (count < 0)
        throw_errno();
}

/// Removes a file on the way out, whatever it has become.
struct Removed {
    fs::path file;
    ~Removed() {
        std::error_code ignored;
        fs::remove(file, ignored);
    }
};

/// Writes a file of its own first and copies it into the stream: some formats are written with
/// seeks, which streams do not take.
void write_stream(const fs::path& named, const fs::path& stream,
                  const std::function<void(const fs::path&)>& write) {
    const Removed temporary{
        temporary_beside(temporary_directory() / ("reradiant" + named.extension().string()))};
    write(temporary.file);
    copy_into_stream(temporary.file, stream);
}

void replace(const fs::path& file, const std::function<void(const fs::path&)>& write) {
    const Removed temporary{temporary_beside(file)};
    write(temporary.file);
    keep_permissions(file, temporary.file);
    sync_to_disk(temporary.file);
    fs::rename(temporary.file, file);
}

} // namespace

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
    try {
        const OutputFile output = output_file(file);
        output.is_stream ? write_stream(file, output.file, write) : replace(output.file, write);
    } catch (const std::exception& error) {
        throw_runtime_error(fmt::format("cannot write {}: {}", file.string(), error.what()),
                            "check the folder, its permissions and the free space");
    }
}

void write_text_atomically(const fs::path& file, const std::string& text) {
    write_atomically(file, [&](const fs::path& target) {
        std::FILE* stream = std::fopen(target.c_str(), "wb");
        if (!stream)
            throw_errno();
        const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
        const bool closed = std::fclose(stream) == 0;
        if (!written || !closed)
            throw_errno();
    });
}

} // namespace reradiant
