#pragma once

#include "kernels/core/shared.h"
#include "reradiant/spectral_image.h"
#include "reradiant/wavelength_plan.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace reradiant {

/// A `FilmLayout` says how the film kernel keeps its sums: per lane where every lane belongs to one
/// band, else (or when variance per band is wanted) per band.
struct FilmLayout {
    bool scatter = false;
    bool band_variance = false;
    bool independent_samples = false;     ///< else halves say how much they vary (film_variance.h)
    bool begins_odd = false;              ///< the first sample has an odd number
    int lanes = 0;                        ///< padded columns of a row
    std::vector<std::int32_t> lane_bands; ///< [phase][padded lane]: column in scatter mode, or -1
    std::vector<float> lane_weights; ///< [phase][padded lane][2]: for its column, and for the next
    std::vector<float> y_weights;    ///< [column]
    /// Column to film band and weight, for reading out.
    std::vector<WavelengthPlan::Deposit> columns;

    int rows() const { return band_variance ? 4 : 3; }
    std::size_t floats_per_pixel() const {
        return static_cast<std::size_t>(rows()) * static_cast<std::size_t>(lanes);
    }
};
constexpr std::size_t film_statistics_per_pixel = FILM_STATISTICS;

/// Returns how the sums are kept and how many columns there are, without what is stored by lane.
FilmLayout film_shape(const WavelengthPlan& plan, bool band_variance, bool force_scatter);
/// Returns the whole layout: film_shape with bands and weights of every lane.
FilmLayout film_layout(const WavelengthPlan& plan, bool band_variance, bool force_scatter);

/// Sums of all samples of successive pixels, where the device keeps them.
struct FilmStrip {
    std::size_t first_pixel = 0;
    std::span<const float> sums;       ///< [pixel][row][column], see kernels/film.cl
    std::span<const float> statistics; ///< [pixel][film_statistics_per_pixel]

    std::size_t pixels() const { return statistics.size() / film_statistics_per_pixel; }
    std::uint32_t samples(std::size_t pixel) const; ///< how many the pixel took
    std::uint64_t refused() const;
};
/// A film's strips in order. All but the last hold a multiple of `film_strip_unit` pixels.
using FilmSums = std::span<const FilmStrip>;
constexpr std::size_t film_strip_unit = 1024;

/// Appends the means of a strip's pixels, (pixel, band), without what else is known of them.
void append_means(const FilmStrip& strip, const FilmLayout& layout, int bands,
                  std::vector<float>& values);

/// Makes the mean image with sample count and variance of the mean (film_variance.h), strip after
/// strip, so that a strip may go as soon as it was added.
class FilmResolver {
public:
    FilmResolver(const FilmLayout& layout, int width, int height, const WavelengthGrid& bands);
    /// Strips come in order.
    void add(const FilmStrip& strip);
    /// The image, once all strips were added.
    SpectralImage take();

private:
    const FilmLayout& layout_;
    SpectralImage image_;
    /// Squared differences of the film's halves, per pixel, and per band where they are wanted.
    std::vector<float> halves_y_, halves_bands_;
    std::vector<double> y_weights_; ///< of bands
};

} // namespace reradiant
