#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace reradiant::test {

/// Returns the number of standard errors that none of `comparisons` independent normal deviates
/// exceeds in size, but for one run in a million (Sidak), by bisection.
inline double sidak_bound(double comparisons) {
    const double each = -std::expm1(std::log1p(-1e-6) / comparisons);
    double low = 0.0, high = 40.0;
    for (int step = 0; step < 200; ++step) {
        const double between = 0.5 * (low + high);
        (std::erfc(between / std::numbers::sqrt2) > each ? low : high) = between;
    }
    return high;
}

/// Pearson's chi-square of counts against what is expected of each cell.
template <typename Counts>
double chi_square(const Counts& seen, double expected_of_each) {
    double chi = 0.0;
    for (const double count : seen)
        chi += (count - expected_of_each) * (count - expected_of_each) / expected_of_each;
    return chi;
}

/// Returns how far counts are from what is expected of them, in standard deviations of a chi-square
/// above its mean (Wilson and Hilferty 1931). Cells that expect less than 10 are taken together;
/// infinite when they hold more than chance gives. `known_sum`: the counts had to sum up to what is
/// expected, which takes a degree of freedom.
inline double chi_square_sigmas(const std::vector<double>& seen,
                                const std::vector<double>& expected, bool known_sum) {
    double chi = 0.0, rare_seen = 0.0, rare_expected = 0.0;
    int degrees = known_sum ? -1 : 0;
    const auto add = [&](double found, double wanted) {
        chi += (found - wanted) * (found - wanted) / wanted;
        ++degrees;
    };
    for (std::size_t cell = 0; cell < seen.size(); ++cell) {
        if (expected[cell] >= 10.0) {
            add(seen[cell], expected[cell]);
            continue;
        }
        rare_seen += seen[cell];
        rare_expected += expected[cell];
    }
    if (rare_expected >= 10.0)
        add(rare_seen, rare_expected);
    else if (rare_seen > 60.0) // fewer than 10 are expected: less likely than 1e-20
        return std::numeric_limits<double>::infinity();
    const double k = 2.0 / (9.0 * degrees);
    return (std::cbrt(chi / degrees) - (1.0 - k)) / std::sqrt(k);
}

} // namespace reradiant::test
