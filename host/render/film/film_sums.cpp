#include "host/render/film/film_sums.h"

#include "host/render/film/film_pixels.h"
#include "host/render/film/film_variance.h"
#include "kernels/core/features.h"
#include "reradiant/colour.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace reradiant {

namespace {

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

} // namespace

FilmLayout film_shape(const WavelengthPlan& plan, bool band_variance, bool force_scatter) {
    FilmLayout layout;
    layout.band_variance = band_variance;
    layout.scatter = force_scatter || band_variance || !plan.deposits_are_fixed();
    layout.lanes =
        layout.scatter ? (plan.film.count + WIDTH - 1) / WIDTH * WIDTH : plan.padded_lanes();
    return layout;
}

FilmLayout film_layout(const WavelengthPlan& plan, bool band_variance, bool force_scatter) {
    FilmLayout layout = film_shape(plan, band_variance, force_scatter);
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
        for (int band = 0; band < plan.film.count; ++band)
            layout.columns.push_back({band, 1.0, 0.0});
    } else {
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

void append_means(const FilmStrip& strip, const FilmLayout& layout, int bands,
                  std::vector<float>& values) {
    const auto count = static_cast<std::size_t>(bands);
    const std::size_t before = values.size();
    values.resize(before + strip.pixels() * count);
    for_each_pixel(strip, layout, bands, [&](std::size_t at, const PixelSums& sums, std::size_t) {
        const double n = accepted(strip, at);
        for (std::size_t b = 0; b < count; ++b)
            values[before + at * count + b] = static_cast<float>(n > 0.0 ? sums.sum[b] / n : 0.0);
    });
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
                const double d = n > 0.0 ? half_difference(sums, layout_, b, n, samples) : 0.0;
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

} // namespace reradiant
