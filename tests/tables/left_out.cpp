// What specialising the kernels to a scene saves, as a Markdown table: every example scene with the
// features that it needs, and with all of them and every wavelength sampled. Kernels are built anew
// in an empty cache. Arguments: scene files; none: those of tools/examples. Exits with 3 when the
// two images of a scene differ by more than three standard errors of their tile means (Sidak).
// A second table has the price of every feature alone: the reference study, which needs few, with
// one more at a time.
#include "host/device/device.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"
#include "tests/layers/walk_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>

using namespace reradiant;

namespace {

namespace fs = std::filesystem;

constexpr int film_width = 128;
constexpr std::uint32_t samples = 32;
constexpr int tile = 16;

/// An empty cache for kernels, one after the other; the interfaces' tables stay in the user's.
class EmptyCache {
public:
    EmptyCache()
        : folder_(fs::temp_directory_path() /
                  ("reradiant-left-out-" + std::to_string(::getpid()))) {
        fs::create_directories(folder_);
        ::setenv("RERADIANT_CACHE", folder_.c_str(), 1);
    }
    ~EmptyCache() { fs::remove_all(folder_); }
    void empty_programs() const { fs::remove_all(folder_ / "programs"); }
    EmptyCache(const EmptyCache&) = delete;
    EmptyCache& operator=(const EmptyCache&) = delete;

private:
    fs::path folder_;
};

std::vector<fs::path> example_scenes() {
    const fs::path folder = fs::path(RERADIANT_SOURCE_DIR) / "tools" / "examples";
    std::vector<fs::path> scenes;
    for (const char* name :
         {"furnace", "reference-study", "fluorescent-bare", "fluorescent-smooth",
          "fluorescent-rough", "fluorescent-study", "fluorescent-room", "uv-only"})
        scenes.push_back(folder / (std::string(name) + ".toml"));
    return scenes;
}

Scene small_scene(const fs::path& file) {
    Scene scene = load_scene(file);
    const double scale = static_cast<double>(film_width) / scene.film.width;
    scene.film.width = film_width;
    scene.film.height = std::max(1, static_cast<int>(std::lround(scene.film.height * scale)));
    return scene;
}

RenderResult rendered(const Scene& scene, const Device& device, bool all) {
    RenderOptions options;
    options.samples = samples;
    options.all_features = all;
    options.wavelengths.keep_all = all;
    return render(scene, device, options);
}

double mebibytes(std::size_t bytes) {
    return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

double rendering_seconds(const RenderResult& result) {
    return result.trace_seconds + result.shade_seconds;
}

/// Largest distance of two images' tile means over all bands, in standard errors from the spread
/// of the pixels' differences within the tile.
struct TileDistance {
    double largest = 0.0;
    int tiles = 0;
};
TileDistance tile_distance(const SpectralImage& a, const SpectralImage& b) {
    TileDistance distance;
    const int bands = a.bands.count;
    for (int ty = 0; ty + tile <= a.height; ty += tile)
        for (int tx = 0; tx + tile <= a.width; tx += tile)
            for (int band = 0; band < bands; ++band) {
                double sum = 0.0, squares = 0.0, level = 0.0;
                for (int i = 0; i < tile * tile; ++i) {
                    const int pixel = (ty + i / tile) * a.width + tx + i % tile;
                    const auto at = static_cast<std::size_t>(pixel * bands + band);
                    const double va = static_cast<double>(a.values[at]);
                    const double d = va - static_cast<double>(b.values[at]);
                    sum += d;
                    squares += d * d;
                    level += va;
                }
                constexpr double n = tile * tile;
                // what only rounding tells apart has no spread to speak of
                const double rounding = 1e-5 * level / n;
                const double error = std::sqrt(squares) / n + rounding;
                ++distance.tiles;
                if (error > 0.0)
                    distance.largest = std::max(distance.largest, std::fabs(sum / n) / error);
            }
    return distance;
}

std::string on_features(const RenderResult& result) {
    std::string names;
    for (const auto& [name, on] : result.features)
        if (on)
            names += (names.empty() ? "" : " ") + name;
    return names;
}

/// One scene's row; false when its images differ.
bool print_scene(const fs::path& file, const Device& device, const EmptyCache& cache) {
    const Scene scene = small_scene(file);
    cache.empty_programs();
    const RenderResult some = rendered(scene, device, false);
    const RenderResult all = rendered(scene, device, true);
    const TileDistance distance = tile_distance(some.image, all.image);
    const bool same = distance.largest < sidak_bound(distance.tiles);
    fmt::print("| {} | {} | {} / {} | {:.0f} / {:.0f} | {:.1f} / {:.1f} | {:.1f} / {:.1f} | "
               "{:.2f} / {:.2f} | {:.1f}{} |\n",
               file.stem().string(), on_features(some), some.plan.lanes.size(),
               all.plan.lanes.size(), static_cast<double>(some.build.binary_bytes) / 1024.0,
               static_cast<double>(all.build.binary_bytes) / 1024.0, some.build.seconds,
               all.build.seconds, mebibytes(some.device_bytes), mebibytes(all.device_bytes),
               rendering_seconds(some), rendering_seconds(all), distance.largest,
               same ? "" : " **differs**");
    std::fflush(stdout);
    return same;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

RenderResult rendered_with(const Scene& scene, const Device& device, const std::string& feature) {
    RenderOptions options;
    options.samples = samples;
    options.bands = WavelengthGrid{380, 6.25, 64};
    options.also_on = feature;
    return render(scene, device, options);
}

/// Program and buffers of the scene with one feature more than it needs, and its time against that
/// without, the median of turns.
void print_feature(const std::string& feature, const Scene& scene, const Device& device,
                   const EmptyCache& cache, const RenderResult& without) {
    constexpr int turns = 7;
    cache.empty_programs();
    const RenderResult with = rendered_with(scene, device, feature);
    std::vector<double> ratios;
    for (int turn = 0; turn < turns; ++turn) {
        const double plain = rendering_seconds(rendered_with(scene, device, ""));
        ratios.push_back(rendering_seconds(rendered_with(scene, device, feature)) / plain);
    }
    const TileDistance distance = tile_distance(without.image, with.image);
    fmt::print("| {} | {:+.1f} | {:+.2f} | {:+.2f} | {:.2f} | {} |\n", feature,
               (static_cast<double>(with.build.binary_bytes) -
                static_cast<double>(without.build.binary_bytes)) /
                   1024.0,
               with.build.seconds - without.build.seconds,
               mebibytes(with.device_bytes) - mebibytes(without.device_bytes), median(ratios),
               with.image.values == without.image.values ? "bit for bit"
                                                         : fmt::format("{:.1f}", distance.largest));
    std::fflush(stdout);
}

void print_features(const Device& device, const EmptyCache& cache) {
    const Scene scene =
        small_scene(fs::path(RERADIANT_SOURCE_DIR) / "tools" / "examples" / "reference-study.toml");
    cache.empty_programs();
    const RenderResult without = rendered_with(scene, device, "");
    fmt::print(
        "\nreference-study, 64 bands: {:.0f} KiB of programs built in {:.1f} s, {:.1f} MiB "
        "of buffers. One feature more:\n\n"
        "| feature | programs, KiB | building, s | buffers, MiB | rendering with : without | "
        "image differs by, s.e. |\n| --- | --- | --- | --- | --- | --- |\n",
        static_cast<double>(without.build.binary_bytes) / 1024.0, without.build.seconds,
        mebibytes(without.device_bytes));
    for (const auto& [feature, on] : without.features)
        if (!on && feature != "hero" && feature != "double") // no bits: another estimator, type
            print_feature(feature, scene, device, cache, without);
}

} // namespace

int main(int argc, char** argv) {
    std::vector<fs::path> scenes(argv + 1, argv + argc);
    if (scenes.empty())
        scenes = example_scenes();
    const EmptyCache cache;
    prepare_opencl(0);
    const Device device("");
    fmt::print("{} pixels wide, {} samples a pixel; each figure with what the scene needs / with "
               "all features and wavelengths.\n\n"
               "| scene | features that are on | wavelengths | programs, KiB | building, s | "
               "buffers, MiB | rendering, s | images differ by, s.e. |\n"
               "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
               film_width, samples);
    bool all_same = true;
    for (const fs::path& scene : scenes)
        all_same = print_scene(scene, device, cache) && all_same;
    if (argc == 1)
        print_features(device, cache);
    return all_same ? 0 : 3;
}
