#pragma once

#include <array>

namespace reradiant {

/// Integral of a smooth function over [from, to] by the 8 point Gauss-Legendre rule (exact for
/// polynomials of degree 15; nodes and weights: Abramowitz and Stegun, table 25.4).
template <typename Function>
double gauss_legendre_8(double from, double to, Function function) {
    constexpr std::array<double, 4> nodes = {0.1834346424956498049, 0.5255324099163289858,
                                             0.7966664774136267396, 0.9602898564975362317};
    constexpr std::array<double, 4> weights = {0.3626837833783619830, 0.3137066458778872873,
                                               0.2223810344533744706, 0.1012285362903762591};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0.0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
        sum +=
            weights[k] * (function(middle - half * nodes[k]) + function(middle + half * nodes[k]));
    return sum * half;
}

} // namespace reradiant
