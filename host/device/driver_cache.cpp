#include "host/device/driver_cache.h"

#include "host/paths.h"

#include <spdlog/spdlog.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

const std::string mark_prefix = "used-by-";

bool is_running(const std::string& process) {
    const long id = std::strtol(process.c_str(), nullptr, 10);
    return id > 0 && (::kill(static_cast<pid_t>(id), 0) == 0 || errno == EPERM);
}

/// What marks in the cache tell of the processes that used it.
struct Users {
    bool some_died = false, some_run = false;
};
Users users_of(const fs::path& folder) {
    Users users;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.rfind(mark_prefix, 0) == 0)
            (is_running(name.substr(mark_prefix.size())) ? users.some_run : users.some_died) = true;
    }
    return users;
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
    spdlog::info("the last program that used {} died: kernels are built anew, in case one of them "
                 "is damaged",
                 folder.string());
}

/// The mark of this process; it goes when the process ends by itself.
fs::path own_mark;

void mark(const fs::path& folder) {
    own_mark = folder / (mark_prefix + std::to_string(::getpid()));
    std::ofstream{own_mark};
    std::atexit([] {
        std::error_code ignored;
        fs::remove(own_mark, ignored);
    });
}

} // namespace

void prepare_driver_cache() {
    const std::string temporary = "reradiant-" + std::to_string(::getuid());
    for (const fs::path& folder :
         {cache_directory() / "pocl", fs::temp_directory_path() / temporary / "pocl"}) {
        const Users users = users_of(folder);
        if (users.some_died && !users.some_run)
            discard(folder);
        if (!is_usable(folder))
            continue;
        ::setenv("POCL_CACHE_DIR", folder.c_str(), 0); // what the user chose stays
        if (own_mark.empty())
            mark(folder);
        return;
    }
}

} // namespace reradiant
