#include "host/film/colour_image.h"
#include "reradiant/error.h"
#include "reradiant/spectral_image.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

namespace reradiant {

namespace {

/// d^2 / scale, where nothing differs from nothing: 0 / 0 is no error.
double ratio(double squared_difference, double scale) {
    return squared_difference == 0.0 ? 0.0 : squared_difference / scale;
}

void check_alike(const SpectralImage& image, const SpectralImage& reference) {
    if (image.width != reference.width || image.height != reference.height)
        throw_input_error({},
                          fmt::format("sizes differ: {} x {} against {} x {} pixels", image.width,
                                      image.height, reference.width, reference.height),
                          "compare images of one film size");
    if (image.left != reference.left || image.top != reference.top)
        throw_input_error({},
                          fmt::format("display windows differ: from ({}, {}) against ({}, {})",
                                      image.left, image.top, reference.left, reference.top),
                          "compare images of the same place");
    const WavelengthGrid &a = image.bands, &b = reference.bands;
    if (a.count != b.count || std::abs(a.from_nm - b.from_nm) > 1e-5 ||
        std::abs(a.step_nm - b.step_nm) > 1e-5)
        throw_input_error({},
                          fmt::format("bands differ: {}:{}:{} nm against {}:{}:{} nm", a.from_nm,
                                      a.to_nm(), a.step_nm, b.from_nm, b.to_nm(), b.step_nm),
                          "render both with the same --bands");
}

void check_finite(const SpectralImage& image, const char* which) {
    const auto bands = static_cast<std::size_t>(image.bands.count);
    const auto width = static_cast<std::size_t>(image.width);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        if (!std::isfinite(image.values[i]))
            throw_input_error({},
                              fmt::format("{} holds {} at pixel ({}, {}), {} nm", which,
                                          image.values[i], i / bands % width, i / bands / width,
                                          image.bands.centre_nm(static_cast<int>(i % bands))),
                              "no error can be stated for an image that is not finite");
}

/// relmse, rmse, bias and its standard error over the bands of all pixels. The bands of a pixel
/// come from the same paths, so that only pixels count as independent for the standard error;
/// one pixel alone has none (NaN).
void compare_bands(const SpectralImage& image, const SpectralImage& reference, Comparison& result) {
    const std::size_t entries = image.values.size();
    const auto bands = static_cast<std::size_t>(image.bands.count);
    double mean_reference = 0.0;
    for (const float value : reference.values)
        mean_reference += value;
    mean_reference /= static_cast<double>(entries);
    const double floor = 0.01 * mean_reference * mean_reference;

    double relative = 0.0, squares = 0.0, mean = 0.0, deviations = 0.0;
    const std::size_t pixels = entries / bands;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        double sum = 0.0;
        for (std::size_t i = pixel * bands; i < (pixel + 1) * bands; ++i) {
            const double wanted = reference.values[i];
            const double difference = image.values[i] - wanted;
            relative += ratio(difference * difference, wanted * wanted + floor);
            squares += difference * difference;
            sum += difference;
        }
        // Welford's update: no cancellation where the bias is large against its spread.
        const double value = sum / static_cast<double>(bands);
        const double delta = value - mean;
        mean += delta / static_cast<double>(pixel + 1);
        deviations += delta * (value - mean);
    }
    const auto n = static_cast<double>(pixels);
    result.relmse = relative / static_cast<double>(entries);
    result.rmse = std::sqrt(squares / static_cast<double>(entries));
    result.bias = mean;
    result.bias_stderr = pixels > 1 ? std::sqrt(deviations / (n - 1.0) / n)
                                    : std::numeric_limits<double>::quiet_NaN();
}

void compare_colours(const SpectralImage& image, const SpectralImage& reference,
                     Comparison& result) {
    const std::vector<Xyz> ours = xyz_image(image), theirs = xyz_image(reference);
    const Xyz white = xyz_of(illuminant_with_luminance("D65", 1.0));
    double relative = 0.0, colour_difference = 0.0;
    for (std::size_t pixel = 0; pixel < ours.size(); ++pixel) {
        const auto rgb = xyz_to_linear_srgb(ours[pixel]);
        const auto wanted = xyz_to_linear_srgb(theirs[pixel]);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double difference = rgb[channel] - wanted[channel];
            relative += difference * difference / (wanted[channel] * wanted[channel] + 0.01);
        }
        colour_difference +=
            ciede2000(xyz_to_lab(ours[pixel], white), xyz_to_lab(theirs[pixel], white));
    }
    const auto n = static_cast<double>(ours.size());
    result.relmse_srgb = relative / (3.0 * n);
    result.ciede2000 = colour_difference / n;
}

} // namespace

Comparison compare_images(const SpectralImage& image, const SpectralImage& reference) {
    check_alike(image, reference);
    check_finite(image, "the image");
    check_finite(reference, "the reference");
    Comparison result;
    compare_bands(image, reference, result);
    compare_colours(image, reference, result);
    return result;
}

} // namespace reradiant
