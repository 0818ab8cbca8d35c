#include "host/device/driver_cache.h"

#include "host/paths.h"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr int crash_signals[] = {SIGSEGV, SIGBUS, SIGILL, SIGABRT};

// A signal handler may neither allocate nor lock: what it needs is laid out before.
char marker_file[4096];
char crash_message[8192];

void on_crash(int signal) {
    std::signal(signal, SIG_DFL);
    const int file = ::open(marker_file, O_CREAT | O_WRONLY, 0644);
    if (file >= 0)
        ::close(file);
    // nothing can be done about a failure to say so
    [[maybe_unused]] const auto written =
        ::write(STDERR_FILENO, crash_message, std::strlen(crash_message));
    std::raise(signal);
}

void watch_for_crashes(const fs::path& folder) {
    const std::string marker = (folder / "discard").string();
    const std::string message =
        "reradiant: crashed, perhaps by a damaged kernel in the driver's cache; " +
        folder.string() + " will be discarded at the next start: run the command again\n";
    if (marker.size() >= sizeof marker_file || message.size() >= sizeof crash_message)
        return;
    std::strcpy(marker_file, marker.c_str());
    std::strcpy(crash_message, message.c_str());
    for (const int signal : crash_signals) {
        struct sigaction present {};
        // a sanitizer's or a debugger's own handler says more
        if (::sigaction(signal, nullptr, &present) == 0 && present.sa_handler == SIG_DFL)
            std::signal(signal, on_crash);
    }
}

bool is_usable(const fs::path& folder) {
    std::error_code ignored;
    fs::create_directories(folder, ignored);
    return fs::is_directory(folder, ignored) && ::access(folder.c_str(), W_OK | X_OK) == 0;
}

/// Moved away first, so that a program that starts meanwhile finds all of it or nothing.
void discard(const fs::path& folder) {
    std::error_code ignored;
    fs::path away = folder;
    away += "-discarded-" + std::to_string(::getpid());
    fs::rename(folder, away, ignored);
    fs::remove_all(away, ignored);
}

} // namespace

void prepare_driver_cache() {
    const std::string temporary = "reradiant-" + std::to_string(::getuid());
    for (const fs::path& folder :
         {cache_directory() / "pocl", fs::temp_directory_path() / temporary / "pocl"}) {
        std::error_code ignored;
        if (fs::exists(folder / "discard", ignored))
            discard(folder);
        if (!is_usable(folder))
            continue;
        ::setenv("POCL_CACHE_DIR", folder.c_str(), 0); // what the user chose stays
        watch_for_crashes(folder);
        return;
    }
}

} // namespace reradiant
