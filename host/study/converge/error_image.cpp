#include "host/study/converge/error_image.h"

#include "host/film/display/png.h"
#include "host/report/colour_map.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

std::vector<double> pixel_errors(const SpectralImage& image, const SpectralImage& reference) {
    double mean = 0.0;
    for (const float value : reference.values)
        mean += static_cast<double>(value) / static_cast<double>(reference.values.size());
    const double floor = 0.01 * mean * mean;
    const auto bands = static_cast<std::size_t>(reference.bands.count);
    std::vector<double> errors(reference.values.size() / bands, 0.0);
    for (std::size_t i = 0; i < reference.values.size(); ++i) {
        const double wanted = reference.values[i];
        const double difference = static_cast<double>(image.values[i]) - wanted;
        if (difference != 0.0)
            errors[i / bands] +=
                difference * difference / (wanted * wanted + floor) / static_cast<double>(bands);
    }
    return errors;
}

void write_error_png(const std::filesystem::path& file, int width, int height,
                     const std::vector<double>& errors, double brightest) {
    const ColourTable& colours = sequential_colours();
    const double last = static_cast<double>(colours.size() - 1);
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * errors.size());
    for (const double error : errors) {
        // log of 0 is minus infinity: the darkest colour.
        const double share = 1.0 + std::log10(error / brightest) / error_image_decades;
        const Rgb8& colour =
            colours[static_cast<std::size_t>(std::lround(last * std::clamp(share, 0.0, 1.0)))];
        rgb.insert(rgb.end(), colour.begin(), colour.end());
    }
    write_png(file, width, height, rgb, true);
}

} // namespace reradiant
