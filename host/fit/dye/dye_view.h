#pragma once

#include "host/layers/sources/emitting_stack.h"

#include <optional>

namespace reradiant {

/// How a dyed sample was lit and seen.
struct DyeView {
    AirDirection from;
    Side seen = Side::Above;      ///< where the detector is
    std::optional<double> cosine; ///< of the detector's direction; none: all that leaves there

    bool operator==(const DyeView&) const = default;
};

} // namespace reradiant
