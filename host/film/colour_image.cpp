#include "host/film/colour_image.h"

#include "reradiant/spectral_image.h"

namespace reradiant {

std::vector<Xyz> xyz_image(const SpectralImage& image) {
    const std::vector<Xyz> weights = xyz_weights(image.bands);
    const std::size_t pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::vector<Xyz> result(pixels, Xyz{0.0, 0.0, 0.0});
    const float* value = image.values.data();
    for (Xyz& xyz : result)
        for (const Xyz& weight : weights) {
            const double radiance = *value++;
            for (std::size_t channel = 0; channel < 3; ++channel)
                xyz[channel] += weight[channel] * radiance;
        }
    return result;
}

std::vector<float> linear_srgb(const SpectralImage& image) {
    std::vector<float> rgb;
    rgb.reserve(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    for (const Xyz& xyz : xyz_image(image))
        for (const double value : xyz_to_linear_srgb(xyz))
            rgb.push_back(static_cast<float>(value));
    return rgb;
}

} // namespace reradiant
