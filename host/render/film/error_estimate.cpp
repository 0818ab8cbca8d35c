#include "host/render/film/error_estimate.h"

#include "host/render/film/film_pixels.h"
#include "host/render/film/likely_value.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

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

/// What a pixel adds to the estimate, and the part of it whose truth is guessed.
struct PixelError {
    double value = 0.0, guessed = 0.0;
};

/// Whole rows of pixels, with those above and below, which help to tell each other's true values.
class PixelRows {
public:
    PixelRows(FilmSums film, const FilmLayout& layout, int width, int bands)
        : film_(film), layout_(layout), width_(static_cast<std::size_t>(width)),
          rows_(pixels_of(film) / width_), bands_(static_cast<std::size_t>(bands)), sums_(bands) {}

    /// Reads rows [first, end) and their neighbours.
    void read(std::size_t first, std::size_t end) {
        first_ = first == 0 ? 0 : first - 1;
        end_ = std::min(rows_, end + 1);
        seen_.resize((end_ - first_) * width_ * bands_);
        for (std::size_t pixel = first_ * width_; pixel < end_ * width_; ++pixel)
            read_pixel(pixel, &seen_[(pixel - first_ * width_) * bands_]);
    }

    /// d^2 / (truth^2 + floor) of a pixel as it is to be expected, mean over its bands.
    PixelError error(std::size_t x, std::size_t y, double floor) const {
        const SeenValue* own = bands_of(x, y);
        const auto [around, count] = neighbours(x, y);
        std::array<SeenValue, most_neighbours> others;
        PixelError error;
        for (std::size_t b = 0; b < bands_; ++b) {
            const double square = own[b].difference * own[b].difference;
            if (halves_agree(own[b])) {
                const double scale = own[b].value * own[b].value + floor;
                error.value += scale > 0.0 ? square / scale : 0.0;
                continue;
            }
            for (std::size_t k = 0; k < count; ++k)
                others[k] = around[k][b];
            const double term =
                square * expected_inverse_square(own[b], {others.data(), count}, floor);
            error.value += term;
            error.guessed += is_counted(own[b]) ? term : 0.0;
        }
        error.value /= static_cast<double>(bands_);
        error.guessed /= static_cast<double>(bands_);
        return error;
    }

private:
    using Around = std::array<const SeenValue*, most_neighbours>;

    const SeenValue* bands_of(std::size_t x, std::size_t y) const {
        return &seen_[((y - first_) * width_ + x) * bands_];
    }

    std::pair<Around, std::size_t> neighbours(std::size_t x, std::size_t y) const {
        Around around{};
        std::size_t count = 0;
        for (std::size_t v = std::max(y, first_ + 1) - 1; v < std::min(end_, y + 2); ++v)
            for (std::size_t u = std::max<std::size_t>(x, 1) - 1; u < std::min(width_, x + 2); ++u)
                if (u != x || v != y)
                    around[count++] = bands_of(u, v);
        return {around, count};
    }

    void read_pixel(std::size_t pixel, SeenValue* seen) {
        const FilmStrip& strip = *std::prev(
            std::upper_bound(film_.begin(), film_.end(), pixel,
                             [](std::size_t p, const FilmStrip& s) { return p < s.first_pixel; }));
        const std::size_t at = pixel - strip.first_pixel;
        sums_.read(strip, layout_, at);
        const double n = accepted(strip, at);
        for (std::size_t b = 0; b < bands_; ++b)
            seen[b] = n > 0.0 ? SeenValue{sums_.sum[b] / n,
                                          half_difference(sums_, layout_, b, n, strip.samples(at))}
                              : SeenValue{};
    }

    FilmSums film_;
    const FilmLayout& layout_;
    std::size_t width_, rows_, bands_, first_ = 0, end_ = 0;
    PixelSums sums_;
    std::vector<SeenValue> seen_; ///< (pixel, band)
};

/// Rows that are read at a time: enough that their neighbours do not cost as much again.
constexpr std::size_t rows_together = 8;

/// The errors of pixels that are added in order, and how far neighbours differ.
struct ErrorSums {
    double sum = 0.0, guessed = 0.0, squared_differences = 0.0, fourth_powers = 0.0, waiting = 0.0;
    std::size_t pixels = 0;

    void add(PixelError added) {
        const double error = added.value;
        guessed += added.guessed;
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
/// freedom that the differences' kurtosis leaves. Truths that are guessed may be wrong together, as
/// the pixels along one edge are alike.
RelmseEstimate estimate_from(const std::vector<ErrorSums>& parts) {
    constexpr double guess_spread = 0.5; ///< of the logarithm of a guessed pixel's error
    double sum = 0.0, guessed = 0.0, variance = 0.0, fourth_powers = 0.0;
    std::size_t pixels = 0, paired = 0;
    for (const ErrorSums& part : parts) {
        sum += part.sum;
        guessed += part.guessed;
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
    const double chance = student_quantile(freedom) * std::sqrt(2.0 * variance);
    const double guess = student_quantile(1e9) * guess_spread * guessed;
    const double spread = sum > 0.0 ? std::exp(std::hypot(chance, guess) / sum) : 1.0;
    estimate.low = estimate.value / spread;
    estimate.high = estimate.value * spread;
    return estimate;
}

bool is_known(FilmSums film) {
    for (const FilmStrip& strip : film)
        for (std::size_t pixel = 0; pixel < strip.pixels(); ++pixel)
            if (strip.samples(pixel) < 2)
                return false;
    return true;
}

std::size_t parts_of(FilmSums film, std::size_t columns) {
    return (pixels_of(film) / columns + rows_together - 1) / rows_together;
}

/// Calls visit(part, x, y, error) for the pixels that `counts` says, in order within each part.
template <typename Counts, typename Visit>
void for_each_error(FilmSums film, const FilmLayout& layout, int width, int bands,
                    const Counts& counts, const Visit& visit) {
    const double mean = mean_radiance(film, layout, bands);
    const double floor = 0.01 * mean * mean;
    const auto columns = static_cast<std::size_t>(width);
    const std::size_t rows = pixels_of(film) / columns;
    tbb::parallel_for(std::size_t{0}, parts_of(film, columns), [&](std::size_t part) {
        const std::size_t first = part * rows_together, end = std::min(rows, first + rows_together);
        PixelRows pixels(film, layout, width, bands);
        pixels.read(first, end);
        for (std::size_t y = first; y < end; ++y)
            for (std::size_t x = 0; x < columns; ++x)
                if (counts(x, y))
                    visit(part, x, y, pixels.error(x, y, floor));
    });
}

} // namespace

RelmseEstimate estimated_relmse(FilmSums film, const FilmLayout& layout, int width, int bands,
                                std::vector<float>* deciding) {
    if (deciding)
        deciding->assign(pixels_of(film), 0.0f);
    if (!is_known(film))
        return {};
    const auto columns = static_cast<std::size_t>(width);
    std::vector<ErrorSums> parts(parts_of(film, columns));
    for_each_error(
        film, layout, width, bands, [](std::size_t, std::size_t) { return true; },
        [&](std::size_t part, std::size_t x, std::size_t y, PixelError error) {
            if (deciding && decides_where_samples_go(x, y))
                (*deciding)[y * columns + x] = static_cast<float>(error.value);
            else
                parts[part].add(error);
        });
    return estimate_from(parts);
}

std::vector<float> deciding_errors(FilmSums film, const FilmLayout& layout, int width, int bands) {
    const auto columns = static_cast<std::size_t>(width);
    std::vector<float> errors(pixels_of(film), 0.0f);
    if (is_known(film))
        for_each_error(film, layout, width, bands, decides_where_samples_go,
                       [&](std::size_t, std::size_t x, std::size_t y, PixelError error) {
                           errors[y * columns + x] = static_cast<float>(error.value);
                       });
    return errors;
}

} // namespace reradiant
