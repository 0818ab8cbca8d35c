#pragma once

#include <filesystem>

namespace reradiant {

/// Folder that holds `spectra/` and `kernels/`: $RERADIANT_DATA, else what was installed with the
/// program or library, else the source tree, else the share folder of the configured prefix. Throws
/// a run-time Error that names what was tried.
std::filesystem::path data_directory();

inline std::filesystem::path spectra_directory() {
    return data_directory() / "spectra";
}

/// $RERADIANT_CACHE, else $XDG_CACHE_HOME/reradiant, else ~/.cache/reradiant. Not created here.
std::filesystem::path cache_directory();

} // namespace reradiant
