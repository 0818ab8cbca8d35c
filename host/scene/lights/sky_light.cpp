#include "host/scene/lights/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace reradiant {

namespace {

constexpr int WIDTH = 256, HEIGHT = 128;

/// The table ends where the model's does; ozone leaves almost nothing below, and cameras and
/// fluorescence see nothing above.
Spectrum spectrum_of(const std::vector<double>& nm, const std::vector<double>& values) {
    std::vector<double> places{nm.front() - 1.0}, heights{0.0};
    places.insert(places.end(), nm.begin(), nm.end());
    heights.insert(heights.end(), values.begin(), values.end());
    places.push_back(nm.back() + 1.0);
    heights.push_back(0.0);
    return Spectrum::table(std::move(places), std::move(heights));
}

/// Direction of a place in the image (EnvironmentLight), row and column in texels.
Vector3 direction_of(double row, double column) {
    const double theta = std::numbers::pi * row / HEIGHT;
    const double turn = 2.0 * std::numbers::pi * (column / WIDTH - 0.5);
    return {std::sin(theta) * std::sin(turn), std::cos(theta), -std::sin(theta) * std::cos(turn)};
}

/// CIE S 011:2003, type 12: (1 + a exp(b / cos Z)) (1 + c (exp(d x) - exp(d pi / 2)) + e cos^2 x)
/// with a = -1, b = -0.32, c = 10, d = -3, e = 0.45, Z from the zenith and x from the sun. Air: the
/// terms that are about the same on all sides; haze: c exp(d x); the third is uniform.
std::array<double, 3> distribution(const Vector3& direction, const Vector3& to_sun) {
    if (!(direction[1] > 0.0))
        return {0.0, 0.0, 0.0};
    const double cosine =
        std::inner_product(direction.begin(), direction.end(), to_sun.begin(), 0.0);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    const double gradation = 1.0 - std::exp(-0.32 / direction[1]);
    const double even = 1.0 - 10.0 * std::exp(-1.5 * std::numbers::pi) + 0.45 * cosine * cosine;
    return {gradation * even, gradation * 10.0 * std::exp(-3.0 * angle), 1.0};
}

/// Fills the image with the three distributions, each scaled to an irradiance of 1 on a level plane
/// (by the middles of the texels).
void fill(const Vector3& to_sun, Image& image) {
    image.file = "sky";
    image.width = WIDTH;
    image.height = HEIGHT;
    std::array<double, 3> irradiance{};
    std::vector<double> values;
    const double texel = 2.0 * std::numbers::pi * std::numbers::pi / (WIDTH * HEIGHT);
    for (int row = 0; row < HEIGHT; ++row)
        for (int column = 0; column < WIDTH; ++column) {
            const Vector3 direction = direction_of(row + 0.5, column + 0.5);
            const double weight =
                texel * std::sqrt(1.0 - direction[1] * direction[1]) * std::max(0.0, direction[1]);
            for (std::size_t k = 0; k < 3; ++k) {
                values.push_back(distribution(direction, to_sun)[k]);
                irradiance[k] += weight * values.back();
            }
        }
    for (std::size_t i = 0; i < values.size(); ++i)
        image.rgb.push_back(static_cast<float>(values[i] / irradiance[i % 3]));
}

} // namespace

DirectionalLight sun_light(const ClearSkyLight& light, const Vector3& to_sun) {
    return {
        {-to_sun[0], -to_sun[1], -to_sun[2]}, spectrum_of(light.nm, light.direct), SUN_ANGLE_DEG};
}

EnvironmentLight blue_sky_light(const ClearSkyLight& light, const Vector3& to_sun, Image& image) {
    fill(to_sun, image);
    // The image holds the three parts in proportion to their power, since directions are sampled by
    // its colours' sum; what the colours stand for is scaled back.
    std::array<double, 3> powers{};
    std::vector<double> total(light.nm.size(), 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
        powers[k] = std::accumulate(light.diffuse[k].begin(), light.diffuse[k].end(), 0.0) /
                    static_cast<double>(light.nm.size());
        for (std::size_t i = 0; i < total.size(); ++i)
            total[i] += light.diffuse[k][i];
    }
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        image.rgb[i] *= static_cast<float>(powers[i % 3]);
    EnvironmentLight sky;
    sky.radiance = spectrum_of(light.nm, total);
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<double> shares;
        for (std::size_t i = 0; i < total.size(); ++i)
            shares.push_back(powers[k] > 0.0 ? light.diffuse[k][i] / (total[i] * powers[k]) : 0.0);
        sky.primaries.push_back(Spectrum::table(light.nm, std::move(shares)));
    }
    return sky;
}

} // namespace reradiant
