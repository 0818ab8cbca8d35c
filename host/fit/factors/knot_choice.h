#pragma once

#include "host/fit/data/fit_target.h"
#include "host/fit/factors/factor_start.h"

#include <cstddef>
#include <vector>

namespace reradiant {

/// Bands whose values compact curves keep (ascending); between them the curves are linear.
struct CurveKnots {
    std::vector<int> emission, excitation;
};

/// Numbers of four bytes that say where knots lie: one bit a band of either curve.
std::size_t numbers_of_positions(const FitTarget& target);

/// Chooses `count` bands, of both curves together, by taking away one at a time: that which costs
/// least when all values that stay are fitted to the curve again. Every curve keeps at least two;
/// all terms share the bands. A curve's cost is the chi squared that it adds to first order, the
/// other curves being as they are.
CurveKnots choose_knots(const FitTarget& target, const FactorCurves& curves, std::size_t count);

} // namespace reradiant
