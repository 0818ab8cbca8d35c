#include "host/render/wavefront/adaptive.h"

#include "host/render/film/error_estimate.h"

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

namespace reradiant {

namespace {

constexpr int tile_edge = 8;
/// Share of the mean error of a sample that a tile is believed to have at least: a tile whose
/// samples were all black may still see something, and is looked at now and then.
constexpr double least_share = 1e-3;
constexpr std::uint32_t most_samples = 1u << 30; ///< largest count of a pixel that may double

struct Tile {
    double variance = 0.0; ///< error of one sample, summed over pixels
    std::uint32_t pixels = 0, samples = 0, wanted = 0;
};

struct Tiles {
    Tiles(int width, int height)
        : columns((width + tile_edge - 1) / tile_edge), rows((height + tile_edge - 1) / tile_edge),
          all(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

    std::size_t of(std::size_t pixel, int width) const {
        const auto w = static_cast<std::size_t>(width);
        return pixel / w / tile_edge * static_cast<std::size_t>(columns) + pixel % w / tile_edge;
    }
    const Tile& at(int column, int row) const {
        return all[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
    }

    int columns, rows;
    std::vector<Tile> all;
};

void read_film(Tiles& tiles, FilmSums film, std::span<const float> pixel_errors, int width) {
    for (const FilmStrip& strip : film)
        for (std::size_t i = 0; i < strip.pixels(); ++i) {
            const std::size_t pixel = strip.first_pixel + i;
            Tile& tile = tiles.all[tiles.of(pixel, width)];
            ++tile.pixels;
            tile.samples = strip.samples(i);
            const auto w = static_cast<std::size_t>(width);
            if (decides_where_samples_go(pixel % w, pixel / w)) // half of them, hence twice
                tile.variance += 2.0 * static_cast<double>(pixel_errors[pixel]) * tile.samples;
        }
}

/// Mean variance of a pixel in the 3 x 3 tiles around one.
double around(const Tiles& tiles, int column, int row) {
    double variance = 0.0, pixels = 0.0;
    for (int r = std::max(0, row - 1); r <= std::min(tiles.rows - 1, row + 1); ++r)
        for (int c = std::max(0, column - 1); c <= std::min(tiles.columns - 1, column + 1); ++c) {
            variance += tiles.at(c, r).variance;
            pixels += tiles.at(c, r).pixels;
        }
    return variance / pixels;
}

std::vector<double> believed_variances(const Tiles& tiles) {
    double total = 0.0, pixels = 0.0;
    for (const Tile& tile : tiles.all) {
        total += tile.variance;
        pixels += tile.pixels;
    }
    std::vector<double> believed;
    for (int row = 0; row < tiles.rows; ++row)
        for (int column = 0; column < tiles.columns; ++column) {
            const Tile& tile = tiles.at(column, row);
            believed.push_back(
                std::max(0.5 * (tile.variance + around(tiles, column, row) * tile.pixels),
                         least_share * total / pixels * tile.pixels));
        }
    return believed;
}

/// Decides how many samples each tile shall have.
void give_out(Tiles& tiles, std::uint64_t budget, std::uint64_t most) {
    const std::vector<double> variances = believed_variances(tiles);
    // gain of doubling n samples: half of variance / n, for n samples of every pixel
    const auto gain = [&](std::size_t i) {
        const Tile& tile = tiles.all[i];
        return variances[i] / tile.pixels / (static_cast<double>(tile.wanted) * tile.wanted);
    };
    std::priority_queue<std::pair<double, std::size_t>> queue;
    for (std::size_t i = 0; i < tiles.all.size(); ++i) {
        tiles.all[i].wanted = tiles.all[i].samples;
        queue.emplace(gain(i), i);
    }
    for (bool any = false; !queue.empty();) {
        const std::size_t i = queue.top().second;
        queue.pop();
        Tile& tile = tiles.all[i];
        const std::uint64_t cost = std::uint64_t{tile.wanted} * tile.pixels;
        if (tile.wanted > most_samples || cost > (any ? budget : std::max(budget, most)))
            continue;
        const bool over = cost > budget;
        budget -= std::min(cost, budget);
        any = true;
        tile.wanted *= 2;
        queue.emplace(gain(i), i);
        if (over)
            return;
    }
}

} // namespace

std::uint64_t samples_of(FilmSums film) {
    std::uint64_t samples = 0;
    for (const FilmStrip& strip : film)
        for (std::size_t pixel = 0; pixel < strip.pixels(); ++pixel)
            samples += strip.samples(pixel);
    return samples;
}

std::uint32_t samples_before_adapting(const WavelengthPlan& plan) {
    constexpr std::uint32_t of_comb = 4;
    return plan.hero == 0 ? of_comb
                          : std::clamp(2u * static_cast<std::uint32_t>(plan.phases), 16u, 64u);
}

std::vector<AdaptiveGroup> adaptive_groups(FilmSums film, std::span<const float> pixel_errors,
                                           int width, int height, std::uint32_t first_sample,
                                           std::uint64_t budget, std::uint64_t most) {
    Tiles tiles(width, height);
    read_film(tiles, film, pixel_errors, width);
    give_out(tiles, budget, most);
    std::map<std::uint32_t, AdaptiveGroup> groups;
    for (std::size_t pixel = 0; pixel < pixel_errors.size(); ++pixel) {
        const Tile& tile = tiles.all[tiles.of(pixel, width)];
        if (const std::uint32_t more = tile.wanted - tile.samples; more > 0) {
            groups[more].samples = more;
            groups[more].pixels.push_back(
                {static_cast<std::uint32_t>(pixel), first_sample + tile.samples});
        }
    }
    std::vector<AdaptiveGroup> list;
    for (auto& [more, group] : groups)
        list.push_back(std::move(group));
    return list;
}

} // namespace reradiant
