#include "tests/fuzz/fuzz_input.h"

#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>

namespace reradiant::fuzz {

namespace fs = std::filesystem;

namespace {

struct Folder {
    fs::path path;

    Folder() {
        std::error_code ignored;
        const fs::path in_memory = "/dev/shm";
        const bool usable =
            fs::is_directory(in_memory, ignored) && ::access(in_memory.c_str(), W_OK) == 0;
        path = (usable ? in_memory : fs::temp_directory_path()) /
               ("reradiant-fuzz-" + std::to_string(::getpid()));
        fs::create_directories(path);
        ::setenv("RERADIANT_CACHE", (path / "cache").c_str(), 1);
        ::setenv("HOME", path.c_str(), 1);
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

/// Warnings are switched off before the first input, for targets without a folder too: they would
/// take most of the time.
[[maybe_unused]] const bool is_quiet = [] {
    spdlog::set_level(spdlog::level::off);
    return true;
}();

} // namespace

const fs::path& folder() {
    static const Folder own;
    return own.path;
}

fs::path put(const std::string& name, std::string_view bytes) {
    fs::path file = folder() / name;
    // A stream would be slower: writing is most of what a fast reader's execution costs.
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (descriptor < 0 ||
        ::write(descriptor, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
        std::perror(file.c_str());
        std::_Exit(2); // the disk's fault, not the input's
    }
    ::close(descriptor);
    return file;
}

void fail(const std::string& why) {
    std::fprintf(stderr, "fuzz: %s\n", why.c_str());
    std::abort();
}

void require_finite(double value, const char* what) {
    if (!std::isfinite(value))
        fail(std::string("accepted what is not finite: ") + what);
}

} // namespace reradiant::fuzz
