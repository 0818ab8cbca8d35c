#include "host/render/film_sums.h"

#include "host/render/film_variance.h"
#include "host/spectral/colour.h"
#include "kernels/features.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace reradiant {

namespace {

/// What one pixel holds, lanes added to bands, in double.
struct PixelSums {
    explicit PixelSums(int bands)
        : sum(static_cast<std::size_t>(bands)), alternating(sum.size()), squares(sum.size()) {}

    void read(const FilmSums& film, const FilmLayout& layout, std::size_t pixel) {
        std::fill(sum.begin(), sum.end(), 0.0);
        std::fill(alternating.begin(), alternating.end(), 0.0);
        if (layout.band_variance)
            std::fill(squares.begin(), squares.end(), 0.0);
        const float* base = film.sums.data() + pixel * layout.floats_per_pixel();
        const auto lanes = static_cast<std::size_t>(layout.lanes);
        for (std::size_t column = 0; column < layout.columns.size(); ++column) {
            if (layout.columns[column].band < 0)
                continue;
            const auto b = static_cast<std::size_t>(layout.columns[column].band);
            const double weight = layout.columns[column].weight;
            // The compensation holds what the sum is too large by (kernels/film.cl).
            sum[b] += weight * (static_cast<double>(base[column]) -
                                static_cast<double>(base[lanes + column]));
            alternating[b] += weight * static_cast<double>(base[2 * lanes + column]);
            if (layout.band_variance)
                squares[b] += static_cast<double>(base[3 * lanes + column]);
        }
    }

    std::vector<double> sum, alternating, squares;
};

/// Rows of work: large enough to share out, small enough for both cores.
constexpr std::size_t pixels_at_once = 1024;

/// Calls visit(pixel, sums, chunk) for every pixel, chunks of pixels in parallel.
template <typename Visit>
void for_each_pixel(const FilmSums& film, const FilmLayout& layout, std::size_t pixels, int bands,
                    const Visit& visit) {
    const std::size_t chunks = (pixels + pixels_at_once - 1) / pixels_at_once;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        PixelSums sums(bands);
        const std::size_t end = std::min(pixels, (chunk + 1) * pixels_at_once);
        for (std::size_t pixel = chunk * pixels_at_once; pixel < end; ++pixel) {
            sums.read(film, layout, pixel);
            visit(pixel, sums, chunk);
        }
    });
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

double luminance_variance(const FilmSums& film, std::size_t pixel, double n) {
    const float* y = film.statistics.data() + pixel * film_statistics_per_pixel;
    return variance_of_mean(static_cast<double>(y[0]) - static_cast<double>(y[2]),
                            static_cast<double>(y[1]) - static_cast<double>(y[3]), n);
}

/// Mean over pixels and bands. Sums by chunk, added in order: the result does not depend on
/// threads. Between passes this counts in the time of a render, so bands are not told apart.
double mean_radiance(const FilmSums& film, const FilmLayout& layout, std::size_t pixels, int bands,
                     std::uint32_t samples) {
    std::vector<float> weights(static_cast<std::size_t>(layout.lanes), 0.0f);
    for (std::size_t c = 0; c < layout.columns.size(); ++c)
        if (layout.columns[c].band >= 0)
            weights[c] = static_cast<float>(layout.columns[c].weight);
    const std::size_t chunks = (pixels + pixels_at_once - 1) / pixels_at_once;
    std::vector<double> parts(chunks, 0.0);
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        const std::size_t end = std::min(pixels, (chunk + 1) * pixels_at_once);
        for (std::size_t pixel = chunk * pixels_at_once; pixel < end; ++pixel) {
            const float* sums = film.sums.data() + pixel * layout.floats_per_pixel();
            const double n = accepted(film, pixel, samples);
            // the compensation is below what matters to a mean
            const float total = std::inner_product(weights.begin(), weights.end(), sums, 0.0f);
            parts[chunk] += n > 0.0 ? static_cast<double>(total) / n : 0.0;
        }
    });
    return std::accumulate(parts.begin(), parts.end(), 0.0) / (static_cast<double>(pixels) * bands);
}

/// Half the difference of the even and the odd samples' means in one band: its square has the
/// variance of the mean as expectation.
double half_difference(const PixelSums& sums, std::size_t band, double n, std::uint32_t samples) {
    // With an odd count the even half has one sample more.
    const double one_more = samples % 2 == 1 ? sums.sum[band] / n : 0.0;
    return (sums.alternating[band] - one_more) / n;
}

/// d^2 / (value^2 + floor) of one pixel, added over its bands.
double squared_error(const PixelSums& sums, double n, std::uint32_t samples, double floor) {
    double total = 0.0;
    for (std::size_t b = 0; b < sums.sum.size() && n > 0.0; ++b) {
        const double value = sums.sum[b] / n;
        const double d = half_difference(sums, b, n, samples);
        if (value * value + floor > 0.0)
            total += d * d / (value * value + floor);
    }
    return total;
}

/// The errors of pixels that are added in order, and how far neighbours differ.
struct ErrorSums {
    double sum = 0.0, squared_differences = 0.0, waiting = 0.0;
    std::size_t pixels = 0;

    void add(double error) {
        if (pixels++ % 2 == 1)
            squared_differences += (error - waiting) * (error - waiting);
        waiting = error;
        sum += error;
    }
};

/// Pixels are independent but differ in their expected errors, so that the spread over the image
/// says little about the noise of the mean. Neighbours are alike: half the squared difference of
/// two is the variance of one, or somewhat more (collapsed strata; Cochran, Sampling Techniques,
/// 5A.12). The error that the image has and the estimate of it are two such means that hardly
/// correlate (sum and difference of the halves), hence twice the variance; their ratio is near an
/// F distribution of equal degrees of freedom, which is symmetric in its logarithm.
RelmseEstimate estimate_from(const std::vector<ErrorSums>& parts) {
    constexpr double normal_quantile = 1.959964; // of 97.5 %
    double sum = 0.0, variance = 0.0;
    std::size_t pixels = 0, paired = 0;
    for (const ErrorSums& part : parts) {
        sum += part.sum;
        variance += part.squared_differences;
        pixels += part.pixels;
        paired += part.pixels / 2 * 2;
    }
    RelmseEstimate estimate;
    estimate.value = sum / static_cast<double>(pixels);
    if (paired == 0)
        return estimate;
    variance *= static_cast<double>(pixels) / static_cast<double>(paired);
    const double spread =
        sum > 0.0 ? std::exp(normal_quantile * std::sqrt(2.0 * variance) / sum) : 1.0;
    estimate.low = estimate.value / spread;
    estimate.high = estimate.value * spread;
    return estimate;
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

namespace {

/// Squared differences of a film's halves, per pixel, and per pixel and band where they are wanted.
struct Halves {
    Halves(std::size_t pixels, const WavelengthGrid& bands, bool wants_bands)
        : y(pixels), by_band(wants_bands ? pixels * static_cast<std::size_t>(bands.count) : 0),
          weights(xyz_weights(bands)) {}

    void read(std::size_t pixel, const PixelSums& sums, double n, std::uint32_t samples) {
        double luminance = 0.0;
        for (std::size_t b = 0; b < weights.size() && n > 0.0; ++b) {
            const double d = half_difference(sums, b, n, samples);
            luminance += weights[b][1] * d;
            if (!by_band.empty())
                by_band[pixel * weights.size() + b] = static_cast<float>(d * d);
        }
        y[pixel] = static_cast<float>(luminance * luminance);
    }

    std::vector<float> y, by_band;
    std::vector<Xyz> weights;
};

} // namespace

SpectralImage resolve_film(const FilmSums& film, const FilmLayout& layout, int width, int height,
                           const WavelengthGrid& bands, std::uint32_t samples) {
    SpectralImage image;
    image.width = width;
    image.height = height;
    image.bands = bands;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const auto count = static_cast<std::size_t>(bands.count);
    image.values.resize(pixels * count);
    image.variance_bands.resize(layout.band_variance ? pixels * count : 0);
    image.sample_count.resize(pixels);
    image.variance_y.resize(pixels);
    Halves halves(pixels, bands, layout.band_variance);
    for_each_pixel(
        film, layout, pixels, bands.count,
        [&](std::size_t pixel, const PixelSums& sums, std::size_t) {
            const double n = accepted(film, pixel, samples);
            const double scale = n > 0.0 ? 1.0 / n : 0.0;
            for (std::size_t b = 0; b < count; ++b)
                image.values[pixel * count + b] = static_cast<float>(sums.sum[b] * scale);
            for (std::size_t b = 0; layout.band_variance && b < count; ++b)
                image.variance_bands[pixel * count + b] =
                    static_cast<float>(variance_of_mean(sums.sum[b], sums.squares[b], n));
            image.sample_count[pixel] = static_cast<float>(n);
            image.variance_y[pixel] = static_cast<float>(luminance_variance(film, pixel, n));
            halves.read(pixel, sums, n, samples);
        });
    if (!layout.independent_samples) {
        scale_variances(image.variance_y, halves.y, width, height, 1);
        scale_variances(image.variance_bands, halves.by_band, width, height,
                        layout.band_variance ? count : 0);
    }
    return image;
}

RelmseEstimate estimated_relmse(const FilmSums& film, const FilmLayout& layout, int bands,
                                std::uint32_t samples) {
    if (samples < 2)
        return {};
    const std::size_t pixels = film.statistics.size() / film_statistics_per_pixel;
    const double mean = mean_radiance(film, layout, pixels, bands, samples);
    const double floor = 0.01 * mean * mean;
    std::vector<ErrorSums> parts(pixels / pixels_at_once + 1);
    for_each_pixel(film, layout, pixels, bands,
                   [&](std::size_t pixel, const PixelSums& sums, std::size_t chunk) {
                       const double n = accepted(film, pixel, samples);
                       parts[chunk].add(squared_error(sums, n, samples, floor) / bands);
                   });
    return estimate_from(parts);
}

} // namespace reradiant
