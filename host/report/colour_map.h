#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace reradiant {

using Rgb8 = std::array<std::uint8_t, 3>;
using ColourTable = std::array<Rgb8, 256>;

/// Dark blue over green to light yellow: lightness rises throughout, and neighbours are equally far
/// apart in Oklab (Ottosson 2020), so that equal differences of the data look equal.
const ColourTable& sequential_colours();
/// Blue over near-white to red, the same on both sides of the middle.
const ColourTable& diverging_colours();

/// "#rrggbb"
std::string hex_colour(const Rgb8& colour);

} // namespace reradiant
