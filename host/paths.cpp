#include "host/paths.h"

#include "host/error.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

} // namespace

fs::path data_directory() {
    const std::string named = environment("RERADIANT_DATA");
    for (const std::string& candidate :
         {named, std::string(RERADIANT_SOURCE_DIR), std::string(RERADIANT_INSTALL_DATA_DIR)}) {
        std::error_code ignored;
        if (!candidate.empty() && fs::is_directory(fs::path(candidate) / "kernels", ignored))
            return candidate;
    }
    throw_runtime_error(fmt::format("the folders spectra and kernels were not found in '{}', "
                                    "'{}' or '{}'",
                                    named, RERADIANT_SOURCE_DIR, RERADIANT_INSTALL_DATA_DIR),
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
