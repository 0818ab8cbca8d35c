// Prints what specialising the kernels to a scene saves, as a Markdown table: every example scene
// as it is, with all features, and with every wavelength sampled. Kernels are built anew in an
// empty cache; seconds are ratios to the scene as it is, medians of alternating turns. Arguments:
// scene files; none: those of tools/examples. Exits with 3 when two images of a scene differ by
// more than three standard errors of their tile means (Sidak). A second table has the price of
// every feature alone: the reference study, which needs few, with one more at a time.
#include "host/render/plan/render_features.h"
#include "reradiant/device.h"
#include "reradiant/render.h"
#include "reradiant/scene.h"
#include "reradiant/scene_file.h"
#include "tests/support/statistics.h"
#include "tests/tables/built_kernels.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <vector>

using namespace reradiant;

namespace {

namespace fs = std::filesystem;

constexpr int film_width = 128;
constexpr std::uint32_t samples = 32;
constexpr int tile = 16;
constexpr int turns = 7;

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

/// The things that a scene does not need and that it is rendered with all the same.
enum class Extra { Nothing, Features, Wavelengths };

RenderOptions with_extra(Extra extra) {
    RenderOptions options;
    options.samples = samples;
    options.all_features = extra == Extra::Features;
    options.wavelengths.keep_all = extra == Extra::Wavelengths;
    return options;
}

double mebibytes(std::size_t bytes) {
    return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

double kibibytes(std::size_t bytes) {
    return static_cast<double>(bytes) / 1024.0;
}

double thousands(std::size_t count) {
    return static_cast<double>(count) / 1000.0;
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
    const double brightest =
        static_cast<double>(*std::max_element(a.values.begin(), a.values.end()));
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
                // what only rounding tells apart has no spread to speak of, and a factored matrix
                // rounds in proportion to its largest entries
                const double rounding = 1e-5 * level / n + 1e-9 * brightest;
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

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Rendering times with options over those without, the median of alternating turns.
double time_ratio(const Scene& scene, const Device& device, const RenderOptions& options,
                  const RenderOptions& without) {
    std::vector<double> ratios;
    for (int turn = 0; turn < turns; ++turn) {
        const double plain = rendering_seconds(render(scene, device, without));
        ratios.push_back(rendering_seconds(render(scene, device, options)) / plain);
    }
    return median(ratios);
}

/// A scene with the kernels that it needs, and with those of all features.
struct BuiltScene {
    Scene scene;
    std::string name;
    BuiltKernels some, all;
};
BuiltScene built_scene(const fs::path& file) {
    const Scene scene = small_scene(file);
    return {scene, file.stem().string(), kernels_built_anew(scene, with_extra(Extra::Nothing)),
            kernels_built_anew(scene, with_extra(Extra::Features))};
}

/// One scene's row; false when its images differ.
bool print_scene(const BuiltScene& built, const Device& device) {
    const Scene& scene = built.scene;
    const RenderOptions some = with_extra(Extra::Nothing), all = with_extra(Extra::Features),
                        keeping = with_extra(Extra::Wavelengths);
    const RenderResult needed = render(scene, device, some), kept = render(scene, device, keeping);
    const TileDistance features = tile_distance(needed.image, render(scene, device, all).image);
    const TileDistance wavelengths = tile_distance(needed.image, kept.image);
    const bool same = features.largest < test::sidak_bound(features.tiles) &&
                      wavelengths.largest < test::sidak_bound(wavelengths.tiles);
    fmt::print("| {} | {} | {:.0f} / {:.0f} | {:.1f} / {:.1f} | {:.1f} / {:.1f} | {:.1f} / {:.1f} "
               "| {:.2f} | {:.2f} | {} / {} | {:.2f} | {:.1f}, {:.1f}{} |\n",
               built.name, on_features(needed), kibibytes(built.some.source_bytes),
               kibibytes(built.all.source_bytes), thousands(built.some.instructions),
               thousands(built.all.instructions), built.some.seconds, built.all.seconds,
               mebibytes(built.some.device_bytes), mebibytes(built.all.device_bytes),
               rendering_seconds(needed), time_ratio(scene, device, all, some),
               needed.plan.lanes.size(), kept.plan.lanes.size(),
               time_ratio(scene, device, keeping, some), features.largest, wavelengths.largest,
               same ? "" : " **differs**");
    std::fflush(stdout);
    return same;
}

RenderOptions with_feature(const std::string& feature) {
    RenderOptions options;
    options.samples = samples;
    options.bands = WavelengthGrid{380, 6.25, 64};
    options.also_on = feature;
    return options;
}

/// The reference study by the feature that it has more than it needs ("": none).
using BuiltFeatures = std::map<std::string, BuiltKernels>;

BuiltFeatures built_features(const Scene& scene) {
    BuiltFeatures built = {{"", kernels_built_anew(scene, with_feature(""))}};
    for (const auto& [feature, on] : RenderFeatures{}.listed())
        if (feature != "hero" && feature != "double") // no bits: another estimator, another type
            built[feature] = kernels_built_anew(scene, with_feature(feature));
    return built;
}

/// Programs and buffers of the scene with one feature more than it needs, and its time.
void print_feature(const std::string& feature, const BuiltKernels& with,
                   const BuiltKernels& without, const Scene& scene, const Device& device,
                   const RenderResult& plain) {
    const SpectralImage image = render(scene, device, with_feature(feature)).image;
    fmt::print("| {} | {:+.1f} | {:+.1f} | {:+.2f} | {:+.2f} | {:.2f} | {} |\n", feature,
               kibibytes(with.source_bytes) - kibibytes(without.source_bytes),
               thousands(with.instructions) - thousands(without.instructions),
               with.seconds - without.seconds,
               mebibytes(with.device_bytes) - mebibytes(without.device_bytes),
               time_ratio(scene, device, with_feature(feature), with_feature("")),
               image.values == plain.image.values
                   ? "bit for bit"
                   : fmt::format("{:.1f}", tile_distance(plain.image, image).largest));
    std::fflush(stdout);
}

void print_features(const BuiltFeatures& built, const Scene& scene, const Device& device) {
    const BuiltKernels& without = built.at("");
    const RenderResult plain = render(scene, device, with_feature(""));
    fmt::print(
        "\nreference-study, 64 bands: {:.0f} KiB of source, {:.1f} thousand instructions built in "
        "{:.1f} s, {:.1f} MiB of buffers. One feature more:\n\n"
        "| feature | source, KiB | instructions, thousand | building, s | buffers, MiB | "
        "rendering with : without | image differs by, s.e. |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n",
        kibibytes(without.source_bytes), thousands(without.instructions), without.seconds,
        mebibytes(without.device_bytes));
    for (const auto& [feature, on] : plain.features)
        if (!on && built.contains(feature))
            print_feature(feature, built.at(feature), without, scene, device, plain);
}

} // namespace

int main(int argc, char** argv) {
    std::vector<fs::path> files(argv + 1, argv + argc);
    if (files.empty())
        files = example_scenes();
    // all that is built anew comes first: its processes must not inherit a device
    std::vector<BuiltScene> scenes;
    std::transform(files.begin(), files.end(), std::back_inserter(scenes), built_scene);
    const Scene study =
        small_scene(fs::path(RERADIANT_SOURCE_DIR) / "tools" / "examples" / "reference-study.toml");
    const BuiltFeatures features = argc == 1 ? built_features(study) : BuiltFeatures{};

    prepare_opencl(0);
    const Device device("");
    fmt::print(
        "{} pixels wide, {} samples a pixel; where there are two figures: what the scene "
        "needs / all features. \"x all\" is the time with all features or wavelengths over "
        "that with those needed.\n\n"
        "| scene | features that are on | source, KiB | instructions, thousand | building, s "
        "| buffers, MiB | rendering, s | x all features | wavelengths: needed / all | x all "
        "wavelengths | images differ by, s.e. |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        film_width, samples);
    bool all_same = true;
    for (const BuiltScene& scene : scenes)
        all_same = print_scene(scene, device) && all_same;
    if (!features.empty())
        print_features(features, study, device);
    return all_same ? 0 : 3;
}
