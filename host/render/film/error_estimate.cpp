#include "host/render/film/error_estimate.h"

#include "host/render/film/film_pixels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace reradiant {

namespace {

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

/// Pixels side by side in memory, which help to tell each other's true values.
class Neighbours {
public:
    static constexpr std::size_t most = 8;

    explicit Neighbours(int bands)
        : sums_(bands), bands_(static_cast<std::size_t>(bands)), values_(most * bands_),
          differences_(most * bands_), totals_(bands_), squares_(bands_), noise_(bands_) {}

    void read(const FilmStrip& strip, const FilmLayout& layout, std::size_t first,
              std::size_t count) {
        count_ = count;
        for (std::vector<double>* sums : {&totals_, &squares_, &noise_})
            std::fill(sums->begin(), sums->end(), 0.0);
        for (std::size_t k = 0; k < count; ++k) {
            sums_.read(strip, layout, first + k);
            const double n = accepted(strip, first + k);
            for (std::size_t b = 0; b < bands_; ++b) {
                const double value = n > 0.0 ? sums_.sum[b] / n : 0.0;
                values_[k * bands_ + b] = value;
                differences_[k * bands_ + b] =
                    n > 0.0 ? half_difference(sums_, layout, b, n, strip.samples(first + k)) : 0.0;
                totals_[b] += value;
                squares_[b] += value * value;
                noise_[b] += differences_[k * bands_ + b] * differences_[k * bands_ + b];
            }
        }
    }

    /// d^2 / (ref^2 + floor) of one of them, mean over its bands.
    double squared_error(std::size_t k, double floor) const {
        double total = 0.0;
        for (std::size_t b = 0; b < bands_; ++b) {
            const double d = differences_[k * bands_ + b], reference = likely_value(k, b);
            const double square = reference * reference + floor;
            if (square > 0.0)
                total += d * d / square;
        }
        return total / static_cast<double>(bands_);
    }

private:
    /// The truth's posterior mean, for a prior with the mean of the other pixels and as variance
    /// theirs, less what their noise explains; at least what both halves have, for a prior that
    /// knows nothing of a highlight. The pixel's own value would not do: one bright sample makes it
    /// as large as the error, and hides that.
    double likely_value(std::size_t k, std::size_t b) const {
        const double value = values_[k * bands_ + b], d = differences_[k * bands_ + b];
        if (count_ < 2)
            return value;
        const double others = static_cast<double>(count_) - 1.0;
        const double mean = (totals_[b] - value) / others;
        const double spread = (squares_[b] - value * value) / others - mean * mean;
        const double prior = std::max(0.0, spread - (noise_[b] - d * d) / others);
        const double posterior = d != 0.0 ? mean + (value - mean) * prior / (prior + d * d) : value;
        return std::clamp(posterior, value - std::abs(d), value);
    }

    PixelSums sums_;
    std::size_t bands_, count_ = 0;
    std::vector<double> values_, differences_;     ///< (pixel, band)
    std::vector<double> totals_, squares_, noise_; ///< over pixels, (band)
};

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
        for_each_chunk(strip, [&](std::size_t first, std::size_t end, std::size_t chunk) {
            Neighbours neighbours(bands);
            for (std::size_t pixel = first; pixel < end; pixel += Neighbours::most) {
                const std::size_t count = std::min(end - pixel, Neighbours::most);
                neighbours.read(strip, layout, pixel, count);
                for (std::size_t k = 0; k < count; ++k) {
                    const double error = neighbours.squared_error(k, floor);
                    parts[chunk].add(error);
                    if (pixel_errors)
                        (*pixel_errors)[strip.first_pixel + pixel + k] = static_cast<float>(error);
                }
            }
        });
    return estimate_from(parts);
}

} // namespace reradiant
