#pragma once

#include "host/layers/sources/source_transport.h"

#include <memory>

namespace reradiant {

/// Cells twice as thick: each two halves of a cell become one (DepthCells).
StackCells coarser(const StackCells& cells);

/// The transport of a stack with cells twice as thick as those of `fine`, which has so many depth
/// cells. What is the same everywhere in a cell is the same in both halves of it, so that this is
/// exactly what source_transport would make, and costs nothing.
std::shared_ptr<const SourceTransport> coarse_sources(std::shared_ptr<const SourceTransport> fine,
                                                      Eigen::Index cells);

} // namespace reradiant
