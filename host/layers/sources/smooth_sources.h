#pragma once

#include "host/layers/sources/source_transport.h"

namespace reradiant {

/// The transport of a stack in which nothing scatters, by quadrature over the invariant n^2 sin^2.
std::shared_ptr<const SourceTransport> smooth_sources(const StackElements& stack,
                                                      const StackCells& cells);

} // namespace reradiant
