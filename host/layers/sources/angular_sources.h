#pragma once

#include "host/layers/sources/source_transport.h"

namespace reradiant {

/// The transport of a stack in which something scatters: adding on azimuthally averaged flux
/// (Fourier order 0, which is all that isotropic sources see) on cells of direction.
std::shared_ptr<const SourceTransport> angular_sources(const StackElements& stack,
                                                       const StackCells& cells);

} // namespace reradiant
