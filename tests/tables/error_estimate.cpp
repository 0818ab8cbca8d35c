// Prints how right a render is about its own error, as a Markdown table: example scenes in small,
// several seeds each, estimated over true relMSE from 8 samples on, with and without adaptive
// sampling, and the share of the intervals that hold the true error. References of many samples are
// kept in a folder, so that a second run needs none. A row is marked (!) where the median is not
// within 0.9 to 1.1, or nine of ten renders not within 0.7 to 1.4. Exits with 3 where a median is
// off by more than a factor of two.
#include "reradiant/device.h"
#include "reradiant/render.h"
#include "reradiant/scene.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_image.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

using namespace reradiant;

namespace {

namespace fs = std::filesystem;

struct Settings {
    std::vector<fs::path> scenes;
    fs::path references = fs::path(RERADIANT_SOURCE_DIR) / "build" / "error-estimate";
    std::uint32_t seeds = 20, most_samples = 512, reference_samples = 16384;
    int pixels = 2304;
    std::string sampling = "both"; ///< or "even", "adaptive"
};

const std::vector<std::uint32_t> counts{8, 16, 32, 64, 128, 256, 512};

/// One estimate beside the error that it is of.
struct Judged {
    double error = 0.0; ///< true relMSE
    double ratio = 0.0; ///< estimated over true
    bool covered = false;
};
using JudgedByCount = std::map<std::uint32_t, std::vector<Judged>>;

std::vector<fs::path> example_scenes() {
    std::vector<fs::path> scenes;
    for (const char* name : {"fluorescent-bare", "fluorescent-bare-405", "fluorescent-smooth",
                             "fluorescent-smooth-405", "fluorescent-rough", "fluorescent-rough-405",
                             "fluorescent-room", "fluorescent-study", "furnace", "presets",
                             "reference-study", "reference-study-fluorescent", "uv-only"})
        scenes.push_back(fs::path(RERADIANT_SOURCE_DIR) / "tools" / "examples" /
                         (std::string(name) + ".toml"));
    return scenes;
}

/// The scene with its film's proportions and about so many pixels.
Scene small_scene(const fs::path& file, int pixels) {
    Scene scene = load_scene(file);
    const double scale = std::sqrt(static_cast<double>(pixels) /
                                   (static_cast<double>(scene.film.width) * scene.film.height));
    const auto scaled = [&](int size) {
        return std::max(1, static_cast<int>(std::lround(size * scale)));
    };
    scene.film.width = scaled(scene.film.width);
    scene.film.height = scaled(scene.film.height);
    return scene;
}

RenderOptions options_for(std::uint32_t samples, std::uint32_t seed, bool adaptive) {
    RenderOptions options;
    options.samples = samples;
    options.seed = seed;
    options.adaptive = adaptive;
    return options;
}

SpectralImage reference_of(const Scene& scene, const Device& device, const Settings& settings) {
    const fs::path file =
        settings.references / fmt::format("{}-{}x{}-{}.exr", scene.file.stem().string(),
                                          scene.film.width, scene.film.height,
                                          settings.reference_samples);
    if (!fs::exists(file)) {
        fs::create_directories(settings.references);
        const RenderOptions options = options_for(settings.reference_samples, 1000000, false);
        write_spectral_exr(file, render(scene, device, options).image);
    }
    return read_spectral_exr(file);
}

/// Judges one render at the first pass that has each count of samples, or nearly: adaptive passes
/// leave over what no tile fits.
void judge_render(const Scene& scene, const Device& device, const RenderOptions& options,
                  const SpectralImage& reference, JudgedByCount& judged) {
    auto next = counts.begin();
    render(scene, device, options, {}, [&](const RenderProgress& state, const auto& image) {
        if (next == counts.end() || state.samples < *next - *next / 8)
            return;
        const double error = compare_images(image(), reference).relmse;
        judged[*next++].push_back(
            {error, state.relmse / error, state.relmse_low <= error && error <= state.relmse_high});
    });
}

/// The value that a share of the sorted ones lies below, linear between two.
double quantile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

/// Prints one row; false where the median is off by more than a factor of two.
bool print_row(const std::string& scene, bool adaptive, std::uint32_t samples,
               const std::vector<Judged>& judged) {
    std::vector<double> ratios;
    double errors = 0.0;
    for (const Judged& one : judged) {
        ratios.push_back(one.ratio);
        errors += one.error / static_cast<double>(judged.size());
    }
    std::sort(ratios.begin(), ratios.end());
    const auto covered =
        std::count_if(judged.begin(), judged.end(), [](const Judged& one) { return one.covered; });
    const double median = quantile(ratios, 0.5);
    const bool right = median >= 0.9 && median <= 1.1 && quantile(ratios, 0.1) >= 0.7 &&
                       quantile(ratios, 0.9) <= 1.4;
    fmt::print("| {} | {} | {} | {:.2e} | {:.2f}{} | {:.2f} | {:.2f} | {} of {} |\n", scene,
               adaptive ? "adaptive" : "even", samples, errors, median, right ? "" : " (!)",
               quantile(ratios, 0.1), quantile(ratios, 0.9), covered, judged.size());
    std::fflush(stdout);
    return median >= 0.5 && median <= 2.0;
}

bool print_scene(const fs::path& file, const Device& device, const Settings& settings) {
    const Scene scene = small_scene(file, settings.pixels);
    const SpectralImage reference = reference_of(scene, device, settings);
    bool all_right = true;
    for (const bool adaptive : {false, true}) {
        if (settings.sampling == (adaptive ? "even" : "adaptive"))
            continue;
        JudgedByCount judged;
        for (std::uint32_t seed = 0; seed < settings.seeds; ++seed)
            judge_render(scene, device, options_for(settings.most_samples, seed, adaptive),
                         reference, judged);
        for (const auto& [samples, of_seeds] : judged)
            all_right = print_row(file.stem().string(), adaptive, samples, of_seeds) && all_right;
    }
    return all_right;
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app{"Estimated over true relMSE of example scenes in small."};
    app.add_option("scenes", settings.scenes, "scene files; none: the example scenes");
    app.add_option("--seeds", settings.seeds, "renders of each scene");
    app.add_option("--spp", settings.most_samples, "samples of each render at most");
    app.add_option("--pixels", settings.pixels, "of each picture, about");
    app.add_option("--sampling", settings.sampling, "even, adaptive or both");
    app.add_option("--references", settings.references, "folder of the references");
    app.add_option("--reference-spp", settings.reference_samples, "samples of each reference");
    CLI11_PARSE(app, argc, argv);
    if (settings.scenes.empty())
        settings.scenes = example_scenes();

    prepare_opencl(0);
    const Device device("");
    fmt::print(
        "About {} pixels, {} seeds; estimated over true relMSE.\n\n"
        "| scene | sampling | samples | true relMSE | median | 10 % | 90 % | interval holds |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        settings.pixels, settings.seeds);
    bool all_right = true;
    for (const fs::path& file : settings.scenes)
        all_right = print_scene(file, device, settings) && all_right;
    return all_right ? 0 : 3;
}
