#include "tests/film/saturated_colours.h"

#include "reradiant/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace reradiant::test {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

} // namespace

Eigen::Matrix3d srgb_primaries() {
    Eigen::Matrix3d columns;
    for (int k = 0; k < 3; ++k) {
        std::array<double, 3> rgb{0.0, 0.0, 0.0};
        rgb[static_cast<std::size_t>(k)] = 1.0;
        const Xyz xyz = linear_srgb_to_xyz(rgb);
        columns.col(k) << xyz[0], xyz[1], xyz[2];
    }
    return columns;
}

Xyz srgb_white() {
    return linear_srgb_to_xyz({1.0, 1.0, 1.0});
}

Xyz clipped_to_srgb(const Xyz& xyz) {
    auto rgb = xyz_to_linear_srgb(xyz);
    for (double& value : rgb)
        value = std::clamp(value, 0.0, 1.0);
    return linear_srgb_to_xyz(rgb);
}

bool is_in_srgb(const Xyz& xyz, double tolerance) {
    for (const double value : xyz_to_linear_srgb(xyz))
        if (value < -tolerance || value > 1.0 + tolerance)
            return false;
    return true;
}

HueError hue_error(const Xyz& xyz, const Xyz& other) {
    const Xyz white = srgb_white();
    const auto one = xyz_to_lab(xyz, white), two = xyz_to_lab(other, white);
    const auto difference = [](double h1, double h2) {
        return std::remainder(h2 - h1, 360.0 * degree);
    };
    const double angle =
        difference(std::atan2(one[2], one[1]), std::atan2(two[2], two[1])) / degree;
    const double mean = 0.5 * (std::hypot(one[1], one[2]) + std::hypot(two[1], two[2]));
    const double stretch =
        1.5 - 0.5 * std::sqrt(std::pow(mean, 7) / (std::pow(mean, 7) + std::pow(25.0, 7)));
    const double c1 = std::hypot(stretch * one[1], one[2]),
                 c2 = std::hypot(stretch * two[1], two[2]);
    const double h1 = std::atan2(one[2], stretch * one[1]),
                 h2 = std::atan2(two[2], stretch * two[1]);
    const double h = h1 + 0.5 * difference(h1, h2);
    const double t = 1.0 - 0.17 * std::cos(h - 30.0 * degree) + 0.24 * std::cos(2.0 * h) +
                     0.32 * std::cos(3.0 * h + 6.0 * degree) -
                     0.20 * std::cos(4.0 * h - 63.0 * degree);
    const double delta = 2.0 * std::sqrt(c1 * c2) * std::sin(0.5 * difference(h1, h2));
    return {std::abs(angle), std::abs(delta) / (1.0 + 0.0075 * (c1 + c2) * t)};
}

std::vector<Xyz> saturated_colours() {
    const Xyz white = srgb_white();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> peak_nm(420.0, 660.0), sigma_nm(10.0, 60.0),
        luminance(0.02, 1.2), pale(0.0, 0.1);
    std::vector<Xyz> colours;
    while (colours.size() < 1000) {
        Xyz xyz = xyz_of(Spectrum::gaussian(peak_nm(random), sigma_nm(random), 1.0));
        const double scale = luminance(random) / xyz[1], added = pale(random);
        for (std::size_t c = 0; c < 3; ++c)
            xyz[c] = scale * xyz[c] + added * white[c];
        if (!is_in_srgb(xyz, 1e-3))
            colours.push_back(xyz);
    }
    return colours;
}

} // namespace reradiant::test
