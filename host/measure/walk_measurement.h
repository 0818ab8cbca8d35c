#pragma once

#include "host/layers/walk/walk.h"
#include "reradiant/measure.h"

namespace reradiant {

/// Paths for each incident angle that a request without `samples` gets.
inline constexpr long default_walk_samples = 1L << 16U;

/// measure_stack by model C: every value with its standard error, which is 0 where nothing was
/// found or nothing varies. The request has been checked.
Measurement measure_by_walk(const LayerStack& stack, const SubstrateValues& substrate,
                            const WavelengthGrid& bands, const MeasureRequest& request);

} // namespace reradiant
