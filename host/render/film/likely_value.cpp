#include "host/render/film/likely_value.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace reradiant {

namespace {

double square(double x) {
    return x * x;
}

/// The truth's posterior mean, for a prior with the mean of the neighbours and as variance theirs,
/// less what their noise explains; at least what both halves have, for a prior that knows nothing
/// of a highlight. The pixel's own value would not do: a bright sample makes it as large as the
/// error, and hides that.
double shrunk_value(SeenValue seen, std::span<const SeenValue> neighbours) {
    double sum = 0.0, squares = 0.0, noise = 0.0;
    for (const SeenValue& other : neighbours) {
        sum += other.value;
        squares += square(other.value);
        noise += square(other.difference);
    }
    const auto count = static_cast<double>(neighbours.size());
    const double mean = sum / count;
    const double prior = std::max(0.0, squares / count - square(mean) - noise / count);
    const double posterior = mean + (seen.value - mean) * prior / (prior + square(seen.difference));
    return std::clamp(posterior, std::max(0.0, seen.value - std::abs(seen.difference)),
                      std::max(0.0, seen.value));
}

/// Light above a base, found as counts are: `hits` of them had the sum `height`.
struct Counted {
    double base, height, hits, most_height;
};

/// The base is what all pixels around have, or what the pixel's poorer half has if that is more.
/// Neighbours that differ by halves as well are likely to lie on the same edge: each counts for
/// half of what the pixel itself says, since its share may be another one. A single sample can lie
/// in one half only, which looks like one hit; more of them often do too, hence at least 1.5.
Counted counted_light(SeenValue seen, std::span<const SeenValue> neighbours) {
    constexpr double share = 0.5, least_hits = 1.5, most_hits = 25.0;
    double low = seen.value, high = 0.0, sum = seen.value, weight = 1.0;
    for (const SeenValue& other : neighbours) {
        low = std::min(low, other.value);
        high = std::max(high, other.value);
        if (std::abs(other.difference) > 0.3 * other.value) {
            sum += share * other.value;
            weight += share;
        }
    }
    const double pooled = sum / weight;
    low = std::min({std::max(low, seen.value - std::abs(seen.difference)), seen.value, pooled});
    low = std::max(low, 0.0);
    const double height = std::max(pooled - low, 1e-6 * seen.value);
    const double hits =
        std::clamp(square((seen.value - low) / seen.difference), least_hits, most_hits);
    return {low, height, hits * weight, std::clamp((high - low) / height, 1e-6, 8.0)};
}

/// Nodes z of an integral over [0, 1], u = z^3: truths near the base weigh much and need many.
struct Nodes {
    static constexpr std::size_t count = 8;
    std::array<double, count> logarithm{}, cube{};

    Nodes() {
        for (std::size_t k = 0; k < count; ++k) {
            const double z = (static_cast<double>(k) + 0.5) / count;
            logarithm[k] = std::log(z);
            cube[k] = z * z * z;
        }
    }
};

/// The posterior of u = (truth - base) / height for m hits is u^m exp(-m u) up to the largest u.
double counted_inverse_square(const Counted& light, double floor) {
    static const Nodes nodes;
    double sum = 0.0, weights = 0.0;
    for (std::size_t k = 0; k < Nodes::count; ++k) {
        const double u = light.most_height * nodes.cube[k];
        const double weight = std::exp((3.0 * light.hits + 2.0) * nodes.logarithm[k] -
                                       light.hits * (u - light.most_height));
        sum += weight / (square(light.base + u * light.height) + floor);
        weights += weight;
    }
    return sum / weights;
}

} // namespace

double expected_inverse_square(SeenValue seen, std::span<const SeenValue> neighbours,
                               double floor) {
    if (neighbours.empty() || !is_counted(seen)) {
        const double value = neighbours.empty() ? seen.value : shrunk_value(seen, neighbours);
        const double scale = square(value) + floor;
        return scale > 0.0 ? 1.0 / scale : 0.0;
    }
    return counted_inverse_square(counted_light(seen, neighbours), floor);
}

} // namespace reradiant
