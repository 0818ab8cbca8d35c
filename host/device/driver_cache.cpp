#include "host/device/driver_cache.h"

#include "host/base/logging.h"
#include "reradiant/paths.h"

#include <fmt/core.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
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

/// `Users` says what the marks in the cache folder tell of the processes that used it.
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

/// Discards a cache folder. It is moved away first, so that a program that starts meanwhile finds
/// all of it or nothing.
void discard(const fs::path& folder) {
    std::error_code ignored;
    fs::path away = folder;
    away += "-discarded-" + std::to_string(::getpid());
    fs::rename(folder, away, ignored);
    fs::remove_all(away, ignored);
    logging::info("the last program that used {} died: kernels are built anew, in case one of them "
                  "is damaged",
                  folder.string());
}

/// The mark of this process; it goes when the process ends by itself.
fs::path own_mark;

void mark(const fs::path& folder) {
    own_mark = folder / (mark_prefix + std::to_string(::getpid()));
    std::ofstream(own_mark, std::ios::app).flush();
    std::atexit([] {
        std::error_code ignored;
        fs::remove(own_mark, ignored);
    });
}

/// Returns true when $POCL_CACHE_DIR names a folder that PoCL can use. With one that it cannot use
/// PoCL would have no device, so that choice is not kept.
bool user_has_chosen() {
    const char* const chosen = std::getenv("POCL_CACHE_DIR");
    if (chosen == nullptr || *chosen == '\0')
        return false;
    const std::string reason = why_unusable(chosen);
    if (!reason.empty())
        logging::warn("$POCL_CACHE_DIR, {}, cannot be used: {}; PoCL's kernels go elsewhere",
                      chosen, reason);
    return reason.empty();
}

std::string problem; ///< returned by driver_cache_problem

void choose_folder() {
    if (user_has_chosen())
        return;
    const fs::path folder = cache_directory() / "pocl";
    const Users users = users_of(folder);
    if (users.some_died && !users.some_run)
        discard(folder);
    const std::string reason = why_unusable(folder);
    if (!reason.empty()) {
        problem =
            fmt::format("PoCL has no folder for its kernels: {}: {}", folder.string(), reason);
        return;
    }
    ::setenv("POCL_CACHE_DIR", folder.c_str(), 1);
    mark(folder);
}

} // namespace

void prepare_driver_cache() {
    static std::once_flag once;
    std::call_once(once, choose_folder);
}

std::string driver_cache_problem() {
    return problem;
}

} // namespace reradiant
