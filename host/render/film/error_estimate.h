#pragma once

#include "host/render/film/film_sums.h"

#include <limits>
#include <vector>

namespace reradiant {

/// A `RelmseEstimate` is what a render can say about its own relMSE without a reference.
struct RelmseEstimate {
    double value = std::numeric_limits<double>::infinity();
    /// 95 % interval of the error that this very image has, not of its expectation.
    double low = 0.0, high = std::numeric_limits<double>::infinity();
};

/// Estimated relMSE of the mean image against the truth, as `compare` defines it: the mean of
/// d^2 / (ref^2 + 0.01 mean(ref)^2) with d from the difference of the even and the odd samples'
/// halves, which has the variance of the mean, and ref from the pixel and its neighbours. Nothing
/// is known where a pixel has less than two samples, and no interval below two pixels.
/// `pixel_errors`: where each pixel's part goes.
RelmseEstimate estimated_relmse(FilmSums film, const FilmLayout& layout, int bands,
                                std::vector<float>* pixel_errors = nullptr);

} // namespace reradiant
