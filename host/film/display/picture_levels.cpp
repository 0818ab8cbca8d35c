#include "host/film/display/picture_levels.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

constexpr double darkest = 0.1, brightest = 0.9, shown_at = 0.6;
constexpr std::size_t highlight_part = 100;
constexpr double dark_share = 0.05;

bool is_finite(const Xyz& xyz) {
    return std::isfinite(xyz[0]) && std::isfinite(xyz[1]) && std::isfinite(xyz[2]);
}

/// The value that would stand at a place if the values were sorted.
double element(std::vector<double>& values, std::size_t place) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

} // namespace

double body_level(const std::vector<Xyz>& pixels) {
    std::vector<double> levels;
    for (const Xyz& xyz : pixels) {
        const auto rgb = xyz_to_linear_srgb(xyz);
        const double level = *std::max_element(rgb.begin(), rgb.end());
        if (level > 0.0 && std::isfinite(level))
            levels.push_back(level);
    }
    if (levels.empty())
        return 0.0;
    return element(levels, levels.size() / 2);
}

double exposure_of_level(double level) {
    if (level == 0.0 || (level >= darkest && level <= brightest))
        return 0.0;
    return std::round(10.0 * std::log2(shown_at / level)) / 10.0; // as it is printed
}

std::optional<std::array<double, 2>> median_chromaticity(const std::vector<Xyz>& pixels) {
    std::vector<double> luminances, x, y;
    for (const Xyz& xyz : pixels)
        if (is_finite(xyz) && xyz[1] > 0.0)
            luminances.push_back(xyz[1]);
    if (luminances.empty())
        return std::nullopt;
    const std::size_t count = luminances.size();
    const double brightest_body = element(luminances, count - 1 - count / highlight_part);
    for (const Xyz& xyz : pixels) {
        if (!is_finite(xyz) || xyz[1] < dark_share * brightest_body || xyz[1] > brightest_body)
            continue;
        const double sum = xyz[0] + xyz[1] + xyz[2];
        x.push_back(xyz[0] / sum);
        y.push_back(xyz[1] / sum);
    }
    return std::array<double, 2>{element(x, x.size() / 2), element(y, y.size() / 2)};
}

} // namespace reradiant
