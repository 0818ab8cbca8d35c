#include "reradiant/paths.h"

#include "host/base/logging.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <mutex>
#include <set>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// Folder of the program or shared library that this code is in.
fs::path own_folder() {
    Dl_info info{};
    std::error_code failure;
    if (dladdr(reinterpret_cast<const void*>(&own_folder), &info) == 0 || info.dli_fname == nullptr)
        return {};
    // For a program that PATH found only its name is known here, and the working folder may hold
    // another file of that name.
    if (const fs::path name = info.dli_fname; name.has_parent_path())
        if (const fs::path itself = fs::canonical(name, failure); !failure)
            return itself.parent_path();
    return fs::canonical("/proc/self/exe", failure).parent_path();
}

/// Returns the folders where the data may lie: the one that RERADIANT_DATA names, those beside what
/// was installed, the source tree and the folder of the installation.
std::vector<fs::path> data_candidates() {
    std::vector<fs::path> candidates{environment("RERADIANT_DATA")};
    if (const fs::path own = own_folder(); !own.empty())
        // The last is that of a Python module, in lib/python3.x/site-packages/reradiant.
        for (const char* beside :
             {"../share/reradiant", "../../share/reradiant", "../../../../share/reradiant"})
            candidates.push_back(own / beside);
    candidates.insert(candidates.end(), {RERADIANT_SOURCE_DIR, RERADIANT_INSTALL_DATA_DIR});
    return candidates;
}

/// Logs a warning unless it was logged before: the same one again says nothing new.
void warn_once(const std::string& text) {
    static std::mutex mutex;
    static std::set<std::string> said;
    const std::lock_guard lock(mutex);
    if (said.insert(text).second)
        logging::warn("{}", text);
}

/// Returns the folders that the environment names for caches, best first, each with what messages
/// call it.
std::vector<std::pair<fs::path, std::string>> named_cache_folders() {
    std::vector<std::pair<fs::path, std::string>> folders;
    if (const std::string named = environment("RERADIANT_CACHE"); !named.empty())
        folders.emplace_back(named, "$RERADIANT_CACHE");
    if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty())
        folders.emplace_back(fs::path(xdg) / "reradiant", "the folder of $XDG_CACHE_HOME");
    if (const std::string home = environment("HOME"); !home.empty())
        folders.emplace_back(fs::path(home) / ".cache" / "reradiant", "the folder of $HOME");
    return folders;
}

/// Returns why a folder cannot be made this user's own, or an empty text. Among the temporary files
/// anybody may have made it before.
std::string why_not_private(const fs::path& folder) {
    if (const std::string reason = why_unusable(folder); !reason.empty())
        return reason;
    struct stat status {};
    if (::lstat(folder.c_str(), &status) != 0 || status.st_uid != ::getuid())
        return "it belongs to somebody else";
    return ::chmod(folder.c_str(), S_IRWXU) == 0 ? "" : std::strerror(errno);
}

} // namespace

fs::path data_directory() {
    const std::vector<fs::path> candidates = data_candidates();
    std::string tried;
    for (const fs::path& candidate : candidates) {
        std::error_code ignored;
        if (candidate.empty())
            continue;
        if (fs::is_directory(candidate / "kernels", ignored))
            return candidate.lexically_normal();
        tried += fmt::format("{}'{}'", tried.empty() ? "" : ", ", candidate.string());
    }
    throw_runtime_error(
        fmt::format("the folders spectra and kernels were not found in any of {}", tried),
        "set RERADIANT_DATA to the folder that holds them");
}

std::string why_unusable(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
        return failure ? failure.message() : "it is a file";
    return ::access(folder.c_str(), R_OK | W_OK | X_OK) == 0 ? "" : std::strerror(errno);
}

fs::path temporary_directory() {
    const std::string named = environment("TMPDIR");
    if (named.empty())
        return "/tmp";
    std::error_code ignored; // nobody wants a misspelt name made
    const std::string reason =
        fs::exists(named, ignored) ? why_unusable(named) : "there is no such folder";
    if (reason.empty())
        return named;
    warn_once(
        fmt::format("$TMPDIR, {}, cannot be used: {}; temporary files go to /tmp", named, reason));
    return "/tmp";
}

fs::path private_temporary_directory() {
    return temporary_directory() / fmt::format("reradiant-{}", ::getuid());
}

fs::path cache_directory() {
    std::string refused;
    const auto refuse = [&](const std::string& name, const fs::path& folder,
                            const std::string& reason) {
        refused += fmt::format("{}{}, {}, cannot be used: {}", refused.empty() ? "" : "; ", name,
                               folder.string(), reason);
    };
    const auto named = named_cache_folders();
    for (const auto& [folder, name] : named) {
        const std::string reason = why_unusable(folder);
        if (reason.empty()) {
            if (!refused.empty())
                warn_once(fmt::format("{}; caches go to {}", refused, folder.string()));
            return folder;
        }
        refuse(name, folder, reason);
    }
    const fs::path last = private_temporary_directory();
    if (const std::string reason = why_not_private(last); !reason.empty()) {
        refuse("the folder of temporary files", last, reason);
        warn_once(refused + "; nothing is cached");
        return named.empty() ? last : named.front().first;
    }
    if (!refused.empty())
        warn_once(fmt::format("{}; caches go to {}", refused, last.string()));
    return last;
}

} // namespace reradiant
