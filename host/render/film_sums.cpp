#include "host/render/film_sums.h"

#include "host/spectral/colour.h"
#include "kernels/features.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

/// What one pixel holds, lanes added to bands, in double.
struct PixelSums {
    std::vector<double> sum, alternating, squares;
};

PixelSums read_pixel(const FilmSums& film, const FilmLayout& layout, std::size_t pixel, int bands) {
    const auto count = static_cast<std::size_t>(bands);
    PixelSums result{std::vector<double>(count), std::vector<double>(count),
                     std::vector<double>(count)};
    const float* base = film.sums.data() + pixel * layout.floats_per_pixel();
    const auto lanes = static_cast<std::size_t>(layout.lanes);
    for (std::size_t column = 0; column < layout.columns.size(); ++column) {
        const int band = layout.columns[column].band;
        const double weight = layout.columns[column].weight;
        if (band < 0)
            continue;
        const auto b = static_cast<std::size_t>(band);
        // The compensation holds what the sum is too large by (kernels/film.cl).
        result.sum[b] += weight * (static_cast<double>(base[column]) -
                                   static_cast<double>(base[lanes + column]));
        result.alternating[b] += weight * static_cast<double>(base[2 * lanes + column]);
        if (layout.band_variance)
            result.squares[b] += static_cast<double>(base[3 * lanes + column]);
    }
    return result;
}

double accepted(const FilmSums& film, std::size_t pixel, std::uint32_t samples) {
    return samples - static_cast<double>(film.statistics[pixel * film_statistics_per_pixel + 4]);
}

double variance_of_mean(double sum, double sum_of_squares, double n) {
    if (n < 2.0)
        return 0.0;
    const double mean = sum / n;
    return std::max(0.0, sum_of_squares / n - mean * mean) / (n - 1.0);
}

} // namespace

FilmLayout film_layout(const WavelengthPlan& plan, bool band_variance, bool force_scatter) {
    FilmLayout layout;
    layout.band_variance = band_variance;
    layout.scatter = force_scatter || band_variance || !plan.deposits_are_fixed();
    const int padded = plan.padded_lanes();
    const auto lanes = static_cast<int>(plan.lanes.size());
    for (int phase = 0; phase < plan.phases; ++phase)
        for (int lane = 0; lane < padded; ++lane) {
            const auto deposit =
                lane < lanes ? plan.deposit(lane, phase) : WavelengthPlan::Deposit{};
            layout.lane_bands.push_back(deposit.band);
            layout.lane_weights.push_back(static_cast<float>(deposit.weight));
            layout.lane_weights.push_back(static_cast<float>(deposit.next_weight));
        }
    if (layout.scatter) {
        layout.lanes = (plan.film.count + WIDTH - 1) / WIDTH * WIDTH;
        for (int band = 0; band < plan.film.count; ++band)
            layout.columns.push_back({band, 1.0, 0.0});
    } else {
        layout.lanes = padded;
        for (int lane = 0; lane < lanes; ++lane)
            layout.columns.push_back(plan.deposit(lane, 0));
    }
    const std::vector<Xyz> weights = xyz_weights(plan.film);
    layout.y_weights.resize(static_cast<std::size_t>(layout.lanes));
    for (std::size_t c = 0; c < layout.columns.size(); ++c)
        if (layout.columns[c].band >= 0)
            layout.y_weights[c] =
                static_cast<float>(weights[static_cast<std::size_t>(layout.columns[c].band)][1] *
                                   layout.columns[c].weight);
    return layout;
}

std::uint64_t FilmSums::refused() const {
    double total = 0.0;
    for (std::size_t i = 4; i < statistics.size(); i += film_statistics_per_pixel)
        total += static_cast<double>(statistics[i]);
    return static_cast<std::uint64_t>(total);
}

SpectralImage resolve_film(const FilmSums& film, const FilmLayout& layout, int width, int height,
                           const WavelengthGrid& bands, std::uint32_t samples) {
    SpectralImage image;
    image.width = width;
    image.height = height;
    image.bands = bands;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    image.values.reserve(pixels * static_cast<std::size_t>(bands.count));
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const PixelSums sums = read_pixel(film, layout, pixel, bands.count);
        const double n = accepted(film, pixel, samples);
        const double scale = n > 0.0 ? 1.0 / n : 0.0;
        for (std::size_t b = 0; b < sums.sum.size(); ++b) {
            image.values.push_back(static_cast<float>(sums.sum[b] * scale));
            if (layout.band_variance)
                image.variance_bands.push_back(
                    static_cast<float>(variance_of_mean(sums.sum[b], sums.squares[b], n)));
        }
        const float* y = film.statistics.data() + pixel * film_statistics_per_pixel;
        image.sample_count.push_back(static_cast<float>(n));
        image.variance_y.push_back(static_cast<float>(
            variance_of_mean(static_cast<double>(y[0]) - static_cast<double>(y[2]),
                             static_cast<double>(y[1]) - static_cast<double>(y[3]), n)));
    }
    return image;
}

double estimated_relmse(const FilmSums& film, const FilmLayout& layout, const SpectralImage& image,
                        std::uint32_t samples) {
    if (samples < 2)
        return std::numeric_limits<double>::infinity();
    double mean = 0.0;
    for (const float value : image.values)
        mean += static_cast<double>(value) / static_cast<double>(image.values.size());
    const double floor = 0.01 * mean * mean;
    const auto bands = static_cast<std::size_t>(image.bands.count);
    double total = 0.0;
    for (std::size_t pixel = 0; pixel < image.sample_count.size(); ++pixel) {
        const PixelSums sums = read_pixel(film, layout, pixel, image.bands.count);
        const double n = accepted(film, pixel, samples);
        for (std::size_t b = 0; b < bands && n > 0.0; ++b) {
            const double value = static_cast<double>(image.values[pixel * bands + b]);
            // With an odd count the even half has one sample more.
            const double d = sums.alternating[b] / n - (samples % 2 == 1 ? value / n : 0.0);
            if (value * value + floor > 0.0)
                total += d * d / (value * value + floor);
        }
    }
    return total / static_cast<double>(image.values.size());
}

} // namespace reradiant
