#pragma once

#include <cmath>

namespace reradiant {

/// Standard errors that none of `comparisons` independent normal deviates exceeds, but for one run
/// in a million (Sidak; both signs), by bisection.
inline double sidak_bound(double comparisons) {
    const double each = -std::expm1(std::log1p(-1e-6) / comparisons);
    double low = 0.0, high = 40.0;
    for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (low + high);
        (std::erfc(middle / std::sqrt(2.0)) > each ? low : high) = middle;
    }
    return high;
}

} // namespace reradiant
