#include "host/render/film_sums.h"

#include "host/render/film_variance.h"
#include "host/spectral/colour.h"
#include "kernels/features.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace reradiant {

namespace {

/// What one pixel holds, lanes added to bands, in double.
struct PixelSums {
    explicit PixelSums(int bands)
        : sum(static_cast<std::size_t>(bands)), alternating(sum.size()), squares(sum.size()) {}

    void read(const FilmStrip& strip, const FilmLayout& layout, std::size_t pixel) {
        std::fill(sum.begin(), sum.end(), 0.0);
        std::fill(alternating.begin(), alternating.end(), 0.0);
        if (layout.band_variance)
            std::fill(squares.begin(), squares.end(), 0.0);
        const float* base = strip.sums.data() + pixel * layout.floats_per_pixel();
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

std::size_t chunks_of(std::size_t pixels) {
    return (pixels + film_strip_unit - 1) / film_strip_unit;
}

/// Calls visit(first, end, chunk) for chunks of a strip's pixels, in parallel; `chunk` counts
/// through the film.
template <typename Visit>
void for_each_chunk(const FilmStrip& strip, const Visit& visit) {
    tbb::parallel_for(std::size_t{0}, chunks_of(strip.pixels()), [&](std::size_t chunk) {
        const std::size_t first = chunk * film_strip_unit;
        visit(first, std::min(strip.pixels(), first + film_strip_unit),
              strip.first_pixel / film_strip_unit + chunk);
    });
}

/// Calls visit(pixel of the strip, sums, chunk) for every pixel.
template <typename Visit>
void for_each_pixel(const FilmStrip& strip, const FilmLayout& layout, int bands,
                    const Visit& visit) {
    for_each_chunk(strip, [&](std::size_t first, std::size_t end, std::size_t chunk) {
        PixelSums sums(bands);
        for (std::size_t pixel = first; pixel < end; ++pixel) {
            sums.read(strip, layout, pixel);
            visit(pixel, sums, chunk);
        }
    });
}

double accepted(const FilmStrip& strip, std::size_t pixel) {
    return strip.samples(pixel) -
           static_cast<double>(strip.statistics[pixel * film_statistics_per_pixel + 4]);
}

double variance_of_mean(double sum, double sum_of_squares, double n) {
    if (n < 2.0)
        return 0.0;
    const double mean = sum / n;
    return std::max(0.0, sum_of_squares / n - mean * mean) / (n - 1.0);
}

double luminance_variance(const FilmStrip& strip, std::size_t pixel, double n) {
    const float* y = strip.statistics.data() + pixel * film_statistics_per_pixel;
    return variance_of_mean(static_cast<double>(y[0]) - static_cast<double>(y[2]),
                            static_cast<double>(y[1]) - static_cast<double>(y[3]), n);
}

std::size_t pixels_of(FilmSums film) {
    return film.back().first_pixel + film.back().pixels();
}

/// Mean over pixels and bands. Sums by chunk, added in order: the result does not depend on
/// threads. Between passes this counts in the time of a render, so bands are not told apart.
double mean_radiance(FilmSums film, const FilmLayout& layout, int bands) {
    std::vector<float> weights(static_cast<std::size_t>(layout.lanes), 0.0f);
    for (std::size_t c = 0; c < layout.columns.size(); ++c)
        if (layout.columns[c].band >= 0)
            weights[c] = static_cast<float>(layout.columns[c].weight);
    const std::size_t pixels = pixels_of(film);
    std::vector<double> parts(chunks_of(pixels), 0.0);
    for (const FilmStrip& strip : film)
        for_each_chunk(strip, [&](std::size_t first, std::size_t end, std::size_t chunk) {
            for (std::size_t pixel = first; pixel < end; ++pixel) {
                const float* sums = strip.sums.data() + pixel * layout.floats_per_pixel();
                const double n = accepted(strip, pixel);
                // the compensation is below what matters to a mean
                const float total = std::inner_product(weights.begin(), weights.end(), sums, 0.0f);
                parts[chunk] += n > 0.0 ? static_cast<double>(total) / n : 0.0;
            }
        });
    return std::accumulate(parts.begin(), parts.end(), 0.0) / (static_cast<double>(pixels) * bands);
}

/// Half the difference of the even and the odd samples' means in one band: its square has the
/// variance of the mean as expectation.
double half_difference(const PixelSums& sums, std::size_t band, double n, std::uint32_t samples,
                       bool begins_odd) {
    // With an odd count the half of the first sample has one more.
    const double one_more = samples % 2 == 1 ? sums.sum[band] / n : 0.0;
    return (sums.alternating[band] - (begins_odd ? -one_more : one_more)) / n;
}

/// d^2 / (value^2 + floor) of one pixel, added over its bands.
double squared_error(const PixelSums& sums, double n, std::uint32_t samples, bool begins_odd,
                     double floor) {
    double total = 0.0;
    for (std::size_t b = 0; b < sums.sum.size() && n > 0.0; ++b) {
        const double value = sums.sum[b] / n;
        const double d = half_difference(sums, b, n, samples, begins_odd);
        if (value * value + floor > 0.0)
            total += d * d / (value * value + floor);
    }
    return total;
}

/// The errors of pixels that are added in order, and how far neighbours differ.
struct ErrorSums {
    double sum = 0.0, squared_differences = 0.0, fourth_powers = 0.0, waiting = 0.0;
    std::size_t pixels = 0;

    void add(double error) {
        if (pixels++ % 2 == 1) {
            const double square = (error - waiting) * (error - waiting);
            squared_differences += square;
            fourth_powers += square * square;
        }
        waiting = error;
        sum += error;
    }
};

/// Student's t that 97.5 % lie below, from 3 degrees of freedom on, to 0.04 (expansion in their
/// inverse: Abramowitz and Stegun, 26.7.5).
double student_quantile(double freedom) {
    constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
    return z + (z3 + z) / (4.0 * freedom) +
           (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom) +
           (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * freedom * freedom * freedom);
}

/// Pixels are independent but differ in their expected errors, so that the spread over the image
/// says little about the noise of the mean. Neighbours are alike: half the squared difference of
/// two is the variance of one, or somewhat more (collapsed strata; Cochran, Sampling Techniques,
/// 5A.12). The error that the image has and the estimate of it are two such means that hardly
/// correlate (sum and difference of the halves), hence twice the variance; their ratio is near an
/// F distribution of equal degrees of freedom, which is symmetric in its logarithm. Where a few
/// pixels hold most of the variance, it is itself hardly known: Student's t with the degrees of
/// freedom that the differences' kurtosis leaves.
RelmseEstimate estimate_from(const std::vector<ErrorSums>& parts) {
    double sum = 0.0, variance = 0.0, fourth_powers = 0.0;
    std::size_t pixels = 0, paired = 0;
    for (const ErrorSums& part : parts) {
        sum += part.sum;
        variance += part.squared_differences;
        fourth_powers += part.fourth_powers;
        pixels += part.pixels;
        paired += part.pixels / 2 * 2;
    }
    RelmseEstimate estimate;
    estimate.value = sum / static_cast<double>(pixels);
    if (paired == 0)
        return estimate;
    // m squares of normal deviates have m degrees of freedom and a squared sum m / 3 times that of
    // their squares
    const double freedom = fourth_powers > 0.0 ? 3.0 * variance * variance / fourth_powers : 3.0;
    variance *= static_cast<double>(pixels) / static_cast<double>(paired);
    const double spread =
        sum > 0.0 ? std::exp(student_quantile(freedom) * std::sqrt(2.0 * variance) / sum) : 1.0;
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

std::uint32_t FilmStrip::samples(std::size_t pixel) const {
    return std::bit_cast<std::uint32_t>(statistics[pixel * film_statistics_per_pixel + 5]);
}

std::uint64_t FilmStrip::refused() const {
    double total = 0.0;
    for (std::size_t i = 4; i < statistics.size(); i += film_statistics_per_pixel)
        total += static_cast<double>(statistics[i]);
    return static_cast<std::uint64_t>(total);
}

FilmResolver::FilmResolver(const FilmLayout& layout, int width, int height,
                           const WavelengthGrid& bands)
    : layout_(layout) {
    image_.width = width;
    image_.height = height;
    image_.bands = bands;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    // Memory is taken as strips fill it.
    image_.values.reserve(pixels * static_cast<std::size_t>(bands.count));
    image_.variance_bands.reserve(layout.band_variance ? image_.values.capacity() : 0);
    halves_bands_.reserve(image_.variance_bands.capacity());
    image_.sample_count.resize(pixels);
    image_.variance_y.resize(pixels);
    halves_y_.resize(pixels);
    for (const Xyz& weights : xyz_weights(bands))
        y_weights_.push_back(weights[1]);
}

void FilmResolver::add(const FilmStrip& strip) {
    const std::size_t bands = y_weights_.size();
    const bool by_band = layout_.band_variance;
    const std::size_t entries = (strip.first_pixel + strip.pixels()) * bands;
    image_.values.resize(entries);
    image_.variance_bands.resize(by_band ? entries : 0);
    halves_bands_.resize(image_.variance_bands.size());
    for_each_pixel(
        strip, layout_, static_cast<int>(bands),
        [&](std::size_t at, const PixelSums& sums, std::size_t) {
            const std::size_t pixel = strip.first_pixel + at;
            const double n = accepted(strip, at);
            const std::uint32_t samples = strip.samples(at);
            double luminance = 0.0;
            for (std::size_t b = 0; b < bands; ++b) {
                const double d =
                    n > 0.0 ? half_difference(sums, b, n, samples, layout_.begins_odd) : 0.0;
                luminance += y_weights_[b] * d;
                image_.values[pixel * bands + b] =
                    static_cast<float>(n > 0.0 ? sums.sum[b] / n : 0.0);
                if (by_band) {
                    halves_bands_[pixel * bands + b] = static_cast<float>(d * d);
                    image_.variance_bands[pixel * bands + b] =
                        static_cast<float>(variance_of_mean(sums.sum[b], sums.squares[b], n));
                }
            }
            halves_y_[pixel] = static_cast<float>(luminance * luminance);
            image_.sample_count[pixel] = static_cast<float>(n);
            image_.variance_y[pixel] = static_cast<float>(luminance_variance(strip, at, n));
        });
}

SpectralImage FilmResolver::take() {
    if (!layout_.independent_samples) {
        scale_variances(image_.variance_y, halves_y_, image_.width, image_.height, 1);
        scale_variances(image_.variance_bands, halves_bands_, image_.width, image_.height,
                        layout_.band_variance ? y_weights_.size() : 0);
    }
    return std::move(image_);
}

RelmseEstimate estimated_relmse(FilmSums film, const FilmLayout& layout, int bands,
                                std::vector<float>* pixel_errors) {
    for (const FilmStrip& strip : film)
        for (std::size_t pixel = 0; pixel < strip.pixels(); ++pixel)
            if (strip.samples(pixel) < 2)
                return {};
    const double mean = mean_radiance(film, layout, bands);
    const double floor = 0.01 * mean * mean;
    std::vector<ErrorSums> parts(chunks_of(pixels_of(film)));
    if (pixel_errors)
        pixel_errors->resize(pixels_of(film));
    for (const FilmStrip& strip : film)
        for_each_pixel(
            strip, layout, bands, [&](std::size_t pixel, const PixelSums& sums, std::size_t chunk) {
                const double error = squared_error(sums, accepted(strip, pixel),
                                                   strip.samples(pixel), layout.begins_odd, floor) /
                                     bands;
                parts[chunk].add(error);
                if (pixel_errors)
                    (*pixel_errors)[strip.first_pixel + pixel] = static_cast<float>(error);
            });
    return estimate_from(parts);
}

} // namespace reradiant
