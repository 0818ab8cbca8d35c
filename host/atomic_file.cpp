#include "host/atomic_file.h"

#include "host/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

fs::path temporary_beside(const fs::path& file) {
    fs::path temporary = file;
    temporary.replace_filename(fmt::format(".{}.{}.partial{}", file.stem().string(), ::getpid(),
                                           file.extension().string()));
    return temporary;
}

void sync_to_disk(const fs::path& file, int flags) {
    const int descriptor = ::open(file.c_str(), flags);
    if (descriptor < 0 || ::fsync(descriptor) != 0) {
        const int code = errno;
        if (descriptor >= 0)
            ::close(descriptor);
        throw_runtime_error(fmt::format("{}: {}", file.string(), std::strerror(code)));
    }
    ::close(descriptor);
}

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
    throw_runtime_error(fmt::format("cannot write {}: {}", file.string(), reason),
                        "check the folder, its permissions and the free space");
}

} // namespace

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
    const fs::path temporary = temporary_beside(file);
    try {
        // Devices and pipes (/dev/full, /dev/stdout) cannot be renamed over.
        std::error_code ignored;
        if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) {
            write(file);
            return;
        }
        write(temporary);
        sync_to_disk(temporary, O_RDWR);
        fs::rename(temporary, file);
    } catch (const std::exception& error) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        fail(file, error.what());
    }
}

void write_text_atomically(const fs::path& file, const std::string& text) {
    write_atomically(file, [&](const fs::path& target) {
        std::FILE* stream = std::fopen(target.c_str(), "wb");
        if (!stream)
            throw_runtime_error(std::strerror(errno));
        const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
        const bool closed = std::fclose(stream) == 0;
        if (!written || !closed)
            throw_runtime_error(std::strerror(errno));
    });
}

} // namespace reradiant
