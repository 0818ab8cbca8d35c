#pragma once

#include "reradiant/colour_of_matrix.h"

#include <string>

namespace reradiant {

/// What a screen shows of a colour.
struct ScreenColour {
    std::string hex;         ///< "#rrggbb", sRGB
    bool is_clipped = false; ///< the screen's gamut does not hold it
};

/// The screen's colour for a sample beside a white of the same lamp, which is the screen's white:
/// the lamp's white is adapted to D65 (Bradford).
ScreenColour screen_colour(const MatrixColour& colour);

} // namespace reradiant
