#pragma once

#include <filesystem>
#include <string>

namespace reradiant {

/// Folder that holds `spectra/` and `kernels/`: $RERADIANT_DATA, else what was installed with the
/// program or library, else the source tree, else the share folder of the configured prefix. Throws
/// a run-time Error that names what was tried.
std::filesystem::path data_directory();

inline std::filesystem::path spectra_directory() {
    return data_directory() / "spectra";
}

/// The first of $RERADIANT_CACHE, $XDG_CACHE_HOME/reradiant, ~/.cache/reradiant and
/// private_temporary_directory() that files can be put into; it is made where it is not there. A
/// warning says, once, what could not be used and what was taken instead. Where none can be used
/// the first one is returned: what is to be kept there is then not kept.
std::filesystem::path cache_directory();

/// $TMPDIR, or /tmp where that is not set or cannot be used, which a warning says, once.
std::filesystem::path temporary_directory();

/// A folder among the temporary files that is the user's alone: drivers load code from there.
std::filesystem::path private_temporary_directory();

/// Returns why no files can be put into a folder, which is made where it is not there; empty where
/// they can.
std::string why_unusable(const std::filesystem::path& folder);

} // namespace reradiant
