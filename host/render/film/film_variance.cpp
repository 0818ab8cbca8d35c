#include "host/render/film/film_variance.h"

#include <algorithm>

namespace reradiant {

namespace {

constexpr int tile_pixels = 16;

/// A rectangle of pixels of an image, as indices of one of its channels.
struct Tile {
    int x, y, width, height;

    template <typename Visit>
    void for_each(int image_width, std::size_t channels, std::size_t channel,
                  const Visit& visit) const {
        for (int j = y; j < y + height; ++j)
            for (int i = x; i < x + width; ++i)
                visit(static_cast<std::size_t>(j * image_width + i) * channels + channel);
    }
};

void scale_tile(const Tile& tile, std::span<float> variances,
                std::span<const float> squared_differences, int width, std::size_t channels,
                std::size_t channel) {
    double expected = 0.0, found = 0.0;
    tile.for_each(width, channels, channel, [&](std::size_t i) {
        expected += static_cast<double>(variances[i]);
        found += static_cast<double>(squared_differences[i]);
    });
    if (!(expected > 0.0))
        return;
    const auto ratio = static_cast<float>(found / expected);
    tile.for_each(width, channels, channel, [&](std::size_t i) { variances[i] *= ratio; });
}

} // namespace

void scale_variances(std::span<float> variances, std::span<const float> squared_differences,
                     int width, int height, std::size_t channels) {
    for (int y = 0; y < height; y += tile_pixels)
        for (int x = 0; x < width; x += tile_pixels) {
            const Tile tile{x, y, std::min(tile_pixels, width - x),
                            std::min(tile_pixels, height - y)};
            for (std::size_t channel = 0; channel < channels; ++channel)
                scale_tile(tile, variances, squared_differences, width, channels, channel);
        }
}

} // namespace reradiant
