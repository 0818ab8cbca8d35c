#include "host/paths.h"

#include "host/error.h"

#include <fmt/format.h>

#include <cstdlib>
#include <dlfcn.h>
#include <string>
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
    // Of a program that was started without a path only its name is known here.
    const fs::path itself = fs::canonical(info.dli_fname, failure);
    return failure ? fs::canonical("/proc/self/exe", failure).parent_path() : itself.parent_path();
}

/// Where the data may lie: as said, beside what was installed, in the source tree.
std::vector<fs::path> data_candidates() {
    std::vector<fs::path> candidates{environment("RERADIANT_DATA")};
    if (const fs::path own = own_folder(); !own.empty())
        for (const char* beside : {"data", "../share/reradiant", "../../share/reradiant"})
            candidates.push_back(own / beside);
    candidates.insert(candidates.end(), {RERADIANT_SOURCE_DIR, RERADIANT_INSTALL_DATA_DIR});
    return candidates;
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

fs::path cache_directory() {
    if (const std::string named = environment("RERADIANT_CACHE"); !named.empty())
        return named;
    if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty())
        return fs::path(xdg) / "reradiant";
    if (const std::string home = environment("HOME"); !home.empty())
        return fs::path(home) / ".cache" / "reradiant";
    return fs::temp_directory_path() / "reradiant-cache";
}

} // namespace reradiant
