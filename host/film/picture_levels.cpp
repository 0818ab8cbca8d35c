#include "host/film/picture_levels.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

constexpr double darkest = 0.1, brightest = 0.9, shown_at = 0.6;
constexpr std::size_t bright_part = 10, highlight_part = 100;

bool is_finite(const Xyz& xyz) {
    return std::isfinite(xyz[0]) && std::isfinite(xyz[1]) && std::isfinite(xyz[2]);
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
    const auto middle = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2);
    std::nth_element(levels.begin(), middle, levels.end());
    return *middle;
}

double exposure_of_level(double level) {
    if (level == 0.0 || (level >= darkest && level <= brightest))
        return 0.0;
    return std::round(10.0 * std::log2(shown_at / level)) / 10.0; // as it is printed
}

std::optional<std::array<double, 2>> bright_chromaticity(const std::vector<Xyz>& pixels) {
    std::vector<Xyz> lit;
    for (const Xyz& xyz : pixels)
        if (is_finite(xyz) && xyz[1] > 0.0)
            lit.push_back(xyz);
    if (lit.empty())
        return std::nullopt;
    std::sort(lit.begin(), lit.end(), [](const Xyz& a, const Xyz& b) { return a[1] > b[1]; });
    const std::size_t highlights = lit.size() / highlight_part;
    const std::size_t end = std::max(highlights + 1, lit.size() / bright_part);
    Xyz sum{0.0, 0.0, 0.0};
    for (std::size_t k = highlights; k < end; ++k)
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += lit[k][c];
    const double all = sum[0] + sum[1] + sum[2];
    return std::array<double, 2>{sum[0] / all, sum[1] / all};
}

} // namespace reradiant
