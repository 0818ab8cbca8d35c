#pragma once

namespace reradiant {

/// The side of a stack that light comes from or goes to.
enum class Side { Above, Below };

inline Side opposite(Side side) {
    return side == Side::Above ? Side::Below : Side::Above;
}

} // namespace reradiant
