// Measures how much more a render costs than its rays: renders a scene, records every ray, and lets
// Embree trace them alone. Prints one line for each number of bands: medians over repetitions that
// take turns, so that ratios hold on a machine that others use too.
#include "host/geometry/geometry.h"
#include "host/render/wavefront/render_hooks.h"
#include "reradiant/device.h"
#include "reradiant/error.h"
#include "reradiant/render.h"
#include "reradiant/scene.h"
#include "reradiant/scene_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

using namespace reradiant;

namespace {

struct Arguments {
    std::string scene, twin, device;
    std::vector<int> bands = {16, 64};
    unsigned samples = 16, repetitions = 5;
    int threads = 0;
};

struct RecordedRays {
    std::vector<RayRecord> rays;
    bool shadow, coherent;
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// `count` bands from 380 to 780 nm, full vectors of lanes for multiples of 16.
WavelengthGrid bands_of(int count) {
    return {380, 400.0 / count, count};
}

RenderOptions options_of(const Arguments& arguments, int bands) {
    RenderOptions options;
    options.samples = arguments.samples;
    options.threads = arguments.threads;
    options.bands = bands_of(bands);
    return options;
}

std::vector<RecordedRays> record_rays(const Scene& scene, const Device& device,
                                      RenderOptions options) {
    std::vector<RecordedRays> recorded;
    RenderHooks hooks;
    hooks.on_rays = [&](std::span<const RayRecord> rays, bool shadow, bool coherent) {
        recorded.push_back({{rays.begin(), rays.end()}, shadow, coherent});
    };
    options.hooks = &hooks;
    render(scene, device, options);
    return recorded;
}

/// Seconds that Embree takes for all of them, in the order and the batches of the render.
double trace_seconds(const Geometry& geometry, const std::vector<RecordedRays>& recorded,
                     int threads) {
    std::vector<HitRecord> hits;
    std::vector<RayRecord> rays;
    double seconds = 0.0;
    for (const RecordedRays& batch : recorded) {
        rays = batch.rays; // occlude changes them
        hits.resize(rays.size());
        const auto start = std::chrono::steady_clock::now();
        if (batch.shadow)
            geometry.occlude(rays, threads);
        else
            geometry.intersect(rays, hits, batch.coherent, threads);
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    return seconds;
}

/// Renders the twin after every render of the scene: what it costs by comparison, the median.
class Twin {
public:
    Twin(const Arguments& arguments, const Device& device) : device_(device) {
        if (!arguments.twin.empty())
            scene_ = load_scene(arguments.twin);
    }
    void take_turn(const RenderOptions& options, double whole_seconds) {
        if (scene_)
            ratios_.push_back(render(*scene_, device_, options).passes.back().seconds /
                              whole_seconds);
    }
    std::string ratio() const { return scene_ ? fmt::format("{:.2f}", median(ratios_)) : "-"; }

private:
    const Device& device_;
    std::optional<Scene> scene_;
    std::vector<double> ratios_;
};

void measure(const Scene& scene, const Device& device, const Arguments& arguments, int bands) {
    const RenderOptions options = options_of(arguments, bands);
    const Geometry geometry(scene, !scene.textures.empty()); // as the renderer has it
    const std::vector<RecordedRays> recorded = record_rays(scene, device, options); // warms up too
    std::vector<double> alone, whole, ratios;
    Twin twin(arguments, device);
    RenderResult last;
    for (unsigned i = 0; i < arguments.repetitions; ++i) {
        alone.push_back(trace_seconds(geometry, recorded, arguments.threads));
        last = render(scene, device, options);
        whole.push_back(last.passes.back().seconds);
        ratios.push_back(whole.back() / alone.back());
        twin.take_turn(options, whole.back());
    }
    const double million = 1e-6 * static_cast<double>(last.paths);
    fmt::print("| {} | {:.3f} | {:.1f} | {:.3f} | {:.2f} | {:.2f} |", bands, median(alone),
               1e-6 * static_cast<double>(last.rays) / median(alone), median(whole),
               million / median(whole), median(ratios));
    for (const char* stage : {"generate", "intersect", "shade", "occlude", "gather", "film"})
        fmt::print(" {:.3f} |", last.stage_seconds.at(stage));
    fmt::print(" {:.0f} | {:.2e} | {:.3f} | {:.3f} | {:.0f} | {} |\n",
               1e-6 * static_cast<double>(last.mapped_bytes) / million, last.relmse * whole.back(),
               last.setup_seconds, last.build_seconds,
               1e-6 * static_cast<double>(last.device_bytes), twin.ratio());
}

int run(const Arguments& arguments) {
    const Scene scene = load_scene(arguments.scene);
    prepare_opencl(arguments.threads);
    const Device device(arguments.device);
    fmt::print("{}: {} spp, {} repetitions, medians; stages of the last one\n\n", arguments.scene,
               arguments.samples, arguments.repetitions);
    fmt::print("| bands | Embree alone, s | M rays/s | render, s | M paths/s | render : Embree | "
               "generate | intersect | shade | occlude | gather | film | bytes mapped a path | "
               "relMSE x s | set-up, s | kernels, s | device, MB | twin : render |\n");
    fmt::print(
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | "
        "--- | --- | --- | --- |\n");
    for (const int bands : arguments.bands)
        measure(scene, device, arguments, bands);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app{"The cost of a render against that of its rays alone"};
    app.add_option("scene", arguments.scene, "scene file")->required();
    app.add_option("--twin", arguments.twin, "scene whose cost is compared with the first's");
    app.add_option("--bands", arguments.bands, "numbers of bands")->delimiter(',');
    app.add_option("--spp", arguments.samples, "samples a pixel")->check(CLI::PositiveNumber);
    app.add_option("--repeat", arguments.repetitions, "repetitions")->check(CLI::PositiveNumber);
    app.add_option("--threads", arguments.threads, "host threads; 0: all");
    app.add_option("--device", arguments.device, "OpenCL device, by name or number");
    CLI11_PARSE(app, argc, argv);
    try {
        return run(arguments);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return error.exit_code();
    }
}
