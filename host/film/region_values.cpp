#include "host/film/region_values.h"

#include "reradiant/error.h"

#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <limits>

namespace reradiant {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void check_inside(const SpectralImage& image, const ImageRegion& region) {
    if (region.x0 < 0 || region.y0 < 0 || region.x1 >= image.width || region.y1 >= image.height)
        throw_input_error(
            {},
            fmt::format("{} reaches outside the picture, which has {} x {} pixels", region.name,
                        image.width, image.height),
            fmt::format("X is from 0 to {}, Y from 0 to {}", image.width - 1, image.height - 1));
}

std::vector<std::size_t> pixels_of(const SpectralImage& image, const ImageRegion& region) {
    std::vector<std::size_t> pixels;
    for (int y = region.y0; y <= region.y1; ++y)
        for (int x = region.x0; x <= region.x1; ++x)
            if (region.holds(x, y))
                pixels.push_back(static_cast<std::size_t>(y) *
                                     static_cast<std::size_t>(image.width) +
                                 static_cast<std::size_t>(x));
    return pixels;
}

using PixelValue = std::function<double(std::size_t pixel)>;

double mean_of(const std::vector<std::size_t>& pixels, const PixelValue& value) {
    double sum = 0.0;
    for (const std::size_t pixel : pixels)
        sum += value(pixel);
    return sum / static_cast<double>(pixels.size());
}

/// Standard error of a mean of pixels that are independent of each other, of known variances.
double error_by_variance(const std::vector<std::size_t>& pixels, const PixelValue& variance) {
    return std::sqrt(mean_of(pixels, variance) / static_cast<double>(pixels.size()));
}

double error_by_spread(const std::vector<std::size_t>& pixels, const PixelValue& value,
                       double mean) {
    const auto count = static_cast<double>(pixels.size());
    if (pixels.size() < 2)
        return unknown;
    const double mean_square = mean_of(pixels, [&](std::size_t pixel) {
        const double off = value(pixel) - mean;
        return off * off;
    });
    return std::sqrt(mean_square / (count - 1.0));
}

/// One sample has no variance, and the file says 0 there.
ErrorSource source_of(const std::vector<float>& variance, const SpectralImage& image,
                      const std::vector<std::size_t>& pixels) {
    bool has_variance = !variance.empty();
    for (const std::size_t pixel : pixels)
        has_variance =
            has_variance && (image.sample_count.empty() || image.sample_count[pixel] >= 2.0f);
    if (has_variance)
        return ErrorSource::Variance;
    return pixels.size() > 1 ? ErrorSource::Spread : ErrorSource::Unknown;
}

void add_band(RegionValues& values, const SpectralImage& image,
              const std::vector<std::size_t>& pixels, std::size_t band) {
    const auto bands = static_cast<std::size_t>(image.bands.count);
    const auto value = [&](std::size_t pixel) {
        return static_cast<double>(image.values[pixel * bands + band]);
    };
    const double mean = mean_of(pixels, value);
    values.radiance.push_back(mean);
    values.radiance_stderr.push_back(
        values.radiance_error == ErrorSource::Variance
            ? error_by_variance(
                  pixels,
                  [&](std::size_t pixel) { return image.variance_bands[pixel * bands + band]; })
            : error_by_spread(pixels, value, mean));
}

/// Y's own variance, since the bands of one path vary together.
double luminance_error(const RegionValues& values, const SpectralImage& image,
                       const std::vector<std::size_t>& pixels, const std::vector<Xyz>& weights) {
    if (values.luminance_error == ErrorSource::Variance)
        return error_by_variance(pixels,
                                 [&](std::size_t pixel) { return image.variance_y[pixel]; });
    const auto luminance = [&](std::size_t pixel) {
        double y = 0.0;
        for (std::size_t band = 0; band < weights.size(); ++band)
            y += weights[band][1] * image.values[pixel * weights.size() + band];
        return y;
    };
    return error_by_spread(pixels, luminance, values.xyz[1]);
}

} // namespace

ValueRatio ratio_of(double above, double above_stderr, double below, double below_stderr) {
    if (below == 0.0)
        return {unknown, unknown};
    const double value = above / below;
    return {value, std::hypot(above_stderr / below, value * below_stderr / below)};
}

bool ImageRegion::holds(int x, int y) const {
    if (x < x0 || x > x1 || y < y0 || y > y1)
        return false;
    return radius == 0.0 || std::hypot(x - 0.5 * (x0 + x1), y - 0.5 * (y0 + y1)) <= radius;
}

RegionValues region_values(const SpectralImage& image, const ImageRegion& region) {
    check_inside(image, region);
    const std::vector<std::size_t> pixels = pixels_of(image, region);
    const std::vector<Xyz> weights = xyz_weights(image.bands);
    RegionValues values;
    values.pixels = pixels.size();
    values.radiance_error = source_of(image.variance_bands, image, pixels);
    values.luminance_error = source_of(image.variance_y, image, pixels);
    for (std::size_t band = 0; band < weights.size(); ++band) {
        add_band(values, image, pixels, band);
        for (std::size_t c = 0; c < 3; ++c)
            values.xyz[c] += weights[band][c] * values.radiance.back();
    }
    values.luminance_stderr = luminance_error(values, image, pixels, weights);
    return values;
}

} // namespace reradiant
