#pragma once

#include "host/render/film/film_sums.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace reradiant {

/// A `RelmseEstimate` is what a render can say about its own relMSE without a reference.
struct RelmseEstimate {
    double value = std::numeric_limits<double>::infinity();
    /// 95 % interval of the error that this very image has, not of its expectation.
    double low = 0.0, high = std::numeric_limits<double>::infinity();
};

/// In an adaptive render every second pixel, as on a chess board, says where samples go, and the
/// others say how large the error is. By one and the same pixels it would come out too small: those
/// that underestimate their error get fewer samples, and keep it.
constexpr bool decides_where_samples_go(std::size_t x, std::size_t y) {
    return (x + y) % 2 == 1;
}

/// Estimated relMSE of the mean image against the truth, as `compare` defines it: the mean of
/// d^2 / (ref^2 + 0.01 mean(ref)^2) with d from the difference of the even and the odd samples'
/// halves, which has the variance of the mean, and what is to be expected of ref, given the pixel
/// and its neighbours (likely_value.h). Nothing is known where a pixel has less than two samples,
/// and no interval below two pixels. `deciding`: of an adaptive render, where deciding_errors go;
/// the estimate is then of the other pixels alone.
RelmseEstimate estimated_relmse(FilmSums film, const FilmLayout& layout, int width, int bands,
                                std::vector<float>* deciding = nullptr);

/// Returns what each pixel that decides where samples go adds to the relMSE times the number of
/// pixels, 0 for the others and where nothing is known; half the work of an estimate.
std::vector<float> deciding_errors(FilmSums film, const FilmLayout& layout, int width, int bands);

} // namespace reradiant
