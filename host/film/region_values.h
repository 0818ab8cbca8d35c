#pragma once

#include "reradiant/colour.h"
#include "reradiant/spectral_image.h"

#include <string>
#include <vector>

namespace reradiant {

/// Pixels of an image, counted from 0 at its upper left: a rectangle with both its corners, or
/// those of its pixels whose centres lie within a radius of its middle.
struct ImageRegion {
    std::string name; ///< as the user wrote it
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    double radius = 0.0; ///< pixels; 0: the whole rectangle

    bool holds(int x, int y) const;
};

/// What a standard error was taken from: the image's own variance of each pixel's mean, or the
/// spread of the region's pixels, which holds whatever pattern the region has; or it is not known.
enum class ErrorSource { Variance, Spread, Unknown };

/// Means over the pixels of a region, with the standard errors of these means (NaN where unknown).
struct RegionValues {
    std::size_t pixels = 0;
    std::vector<double> radiance, radiance_stderr; ///< per band
    Xyz xyz{0.0, 0.0, 0.0};                        ///< unit radiance at every wavelength has Y = 1
    double luminance_stderr = 0.0;                 ///< of Y
    ErrorSource radiance_error = ErrorSource::Unknown, luminance_error = ErrorSource::Unknown;
};

/// One value over another, with the standard error where the two are independent.
struct ValueRatio {
    double value, standard_error; ///< NaN where what stands below is 0
};
ValueRatio ratio_of(double above, double above_stderr, double below, double below_stderr);

/// Input Error, which says the image's size, for a region that reaches outside.
RegionValues region_values(const SpectralImage& image, const ImageRegion& region);

} // namespace reradiant
