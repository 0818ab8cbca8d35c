#pragma once

#include <string>

namespace reradiant {

/// Gives PoCL, which loads its cached kernels without looking at them, a cache folder of this
/// program's own (see cache_directory). A damaged entry kills the process, so every
/// process leaves a mark there while it runs, and the folder is discarded at the next start when
/// one of them died. What $POCL_CACHE_DIR names stays as it is, or where it cannot be used, a
/// warning says so. Calls after the first change nothing.
void prepare_driver_cache();

/// Returns why PoCL has no folder for its kernels, without which it offers no device; empty when it
/// has one.
std::string driver_cache_problem();

} // namespace reradiant
