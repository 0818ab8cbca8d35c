#pragma once

#include "host/report/html.h"
#include "reradiant/fit.h"

namespace reradiant {

/// Adds the colours of what was fitted and of the result side by side, under D65 and under
/// ultraviolet light alone, as fields and as numbers. Entries that were not measured count as the
/// result has them. Where no emission band is visible, a sentence says so.
void add_swatches(HtmlPage& page, const FitResult& result);

} // namespace reradiant
