#pragma once

namespace reradiant {

/// Gives PoCL, which loads its cached kernels without looking at them, a cache folder of this
/// program's own. Where that cannot be made, one among the temporary files. When the driver crashes
/// (a damaged entry does that, CASES 40) the message says so and the folder is discarded at the
/// next start.
void prepare_driver_cache();

} // namespace reradiant
