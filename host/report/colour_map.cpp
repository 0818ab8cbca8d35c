#include "host/report/colour_map.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace reradiant {

namespace {

using Triple = std::array<double, 3>;

/// Oklab to linear sRGB, Ottosson 2020 ("A perceptual color space for image processing").
Triple linear_srgb_of_oklab(const Triple& lab) {
    const double l = std::pow(lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2], 3);
    const double m = std::pow(lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2], 3);
    const double s = std::pow(lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2], 3);
    return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool is_displayable(const Triple& lab) {
    const Triple rgb = linear_srgb_of_oklab(lab);
    return std::all_of(rgb.begin(), rgb.end(), [](double c) { return c >= 0.0 && c <= 1.0; });
}

Rgb8 rgb8_of_oklab(const Triple& lab) {
    Rgb8 result{};
    const Triple linear = linear_srgb_of_oklab(lab);
    for (std::size_t c = 0; c < 3; ++c) {
        const double v = std::clamp(linear[c], 0.0, 1.0);
        const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
        result[c] = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
    }
    return result;
}

/// A colour of this lightness and hue with the wanted chroma, or as much of it as sRGB holds.
Triple coloured(double lightness, double hue_deg, double wanted_chroma) {
    const double hue = hue_deg * std::numbers::pi / 180.0;
    const auto with = [&](double chroma) {
        return Triple{lightness, chroma * std::cos(hue), chroma * std::sin(hue)};
    };
    if (is_displayable(with(wanted_chroma)))
        return with(wanted_chroma);
    double inside = 0.0, outside = wanted_chroma;
    for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (inside + outside);
        (is_displayable(with(middle)) ? inside : outside) = middle;
    }
    return with(inside);
}

double distance(const Triple& a, const Triple& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// `count` points along a path (0 to 1), the same Oklab distance apart.
template <class Path>
std::vector<Triple> equally_spaced(const Path& path, std::size_t count) {
    constexpr std::size_t pieces = 8192;
    std::vector<Triple> points{path(0.0)};
    std::vector<double> length{0.0};
    for (std::size_t k = 1; k <= pieces; ++k) {
        points.push_back(path(static_cast<double>(k) / pieces));
        length.push_back(length.back() + distance(points[k], points[k - 1]));
    }
    std::vector<Triple> result;
    for (std::size_t n = 0; n < count; ++n) {
        const double wanted =
            length.back() * static_cast<double>(n) / static_cast<double>(count - 1);
        const auto at = std::lower_bound(length.begin(), length.end(), wanted);
        result.push_back(points[static_cast<std::size_t>(at - length.begin())]);
    }
    return result;
}

} // namespace

const ColourTable& sequential_colours() {
    static const ColourTable table = [] {
        const auto path = [](double t) {
            return coloured(0.20 + 0.74 * t, 290.0 - 185.0 * t, 0.135);
        };
        const std::vector<Triple> points = equally_spaced(path, 256);
        ColourTable made{};
        std::transform(points.begin(), points.end(), made.begin(), rgb8_of_oklab);
        return made;
    }();
    return table;
}

const ColourTable& diverging_colours() {
    static const ColourTable table = [] {
        ColourTable made{};
        for (const bool warm : {false, true}) {
            const auto path = [warm](double t) { // from the middle outwards
                return coloured(0.97 - 0.57 * t, warm ? 30.0 : 255.0, 0.19 * t);
            };
            const std::vector<Triple> points = equally_spaced(path, 128);
            for (std::size_t n = 0; n < 128; ++n)
                made[warm ? 128 + n : 127 - n] = rgb8_of_oklab(points[n]);
        }
        return made;
    }();
    return table;
}

std::string hex_colour(const Rgb8& colour) {
    return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

} // namespace reradiant
