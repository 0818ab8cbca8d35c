#pragma once

#include "host/render/film/film_sums.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace reradiant {

/// A `PixelSums` holds the sums of one pixel in double, with lanes added to bands.
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

inline std::size_t chunks_of(std::size_t pixels) {
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

/// Samples of a pixel that were not refused.
inline double accepted(const FilmStrip& strip, std::size_t pixel) {
    return strip.samples(pixel) -
           static_cast<double>(strip.statistics[pixel * film_statistics_per_pixel + 4]);
}

/// Half the difference of the even and the odd samples' means in one band: its square has the
/// variance of the mean as expectation.
inline double half_difference(const PixelSums& sums, const FilmLayout& layout, std::size_t band,
                              double n, std::uint32_t samples) {
    // With an odd count the half that holds the first sample has one more.
    const double one_more = samples % 2 == 1 ? sums.sum[band] / n : 0.0;
    return (sums.alternating[band] - (layout.begins_odd ? -one_more : one_more)) / n;
}

} // namespace reradiant
