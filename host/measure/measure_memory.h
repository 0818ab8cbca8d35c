#pragma once

#include "reradiant/measure.h"

namespace reradiant {

/// Input Error when a measurement would take more memory than request.memory_limit_bytes: matrices
/// between all bands, and rows, which are kept and then written as one text.
void check_measure_memory(const Material& material, const WavelengthGrid& bands,
                          const MeasureRequest& request);

} // namespace reradiant
