#pragma once

namespace reradiant {

/// Gives PoCL, which loads its cached kernels without looking at them, a cache folder of this
/// program's own. Where that cannot be made, one among the temporary files. A damaged entry kills
/// the process (CASES 40), so every process leaves a mark there while it runs, and the folder is
/// discarded at the next start when one of them died.
void prepare_driver_cache();

} // namespace reradiant
