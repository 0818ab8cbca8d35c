// Google Benchmark: how a render's time grows with bands, rank of re-radiation, layers, depth,
// pixels, lights and triangles. Each is a small render of one study with one number changed; the
// counters are what was done in a second of the render proper, and what was needed before it.
#include "reradiant/device.h"
#include "reradiant/render.h"
#include "reradiant/scene.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <sys/resource.h>

using namespace reradiant;

namespace {

const Device& device() {
    static const Device opened = [] {
        prepare_opencl(0);
        return Device("");
    }();
    return opened;
}

struct Study {
    int bands = 64, rank = 0, layers = 1, depth = 8, lights = 1, sphere_rows = 0, side = 256;
    double alpha = 0.0;
};

Material paint(const Study& study) {
    Material material;
    material.name = "paint";
    for (int k = 0; k < study.layers; ++k) {
        Layer& layer = material.stack.layers.emplace_back();
        layer.ior = Spectrum::constant(1.4 + 0.1 * (k % 3));
        layer.alpha = study.alpha;
        layer.absorption = Spectrum::constant(0.1);
    }
    material.substrate.reflectance = Spectrum::constant(study.rank > 0 ? 0.1 : 0.5);
    for (int k = 0; k < study.rank; ++k) {
        const double peak = 420.0 + 40.0 * k;
        material.substrate.fluorophores.push_back({Spectrum::gaussian(peak, 25.0, 0.8 / study.rank),
                                                   Spectrum::gaussian(peak + 90.0, 25.0, 1.0),
                                                   0.9});
    }
    return material;
}

/// A unit sphere at (0, 1, 0) of 4 rows^2 triangles.
MeshShape sphere_mesh(int rows) {
    MeshShape mesh;
    const auto columns = static_cast<std::uint32_t>(2 * rows);
    for (int i = 0; i <= rows; ++i)
        for (std::uint32_t j = 0; j < columns; ++j) {
            const double theta = std::numbers::pi * i / rows;
            const double phi = 2.0 * std::numbers::pi * j / columns, s = std::sin(theta);
            for (const double x : {s * std::cos(phi), 1.0 + std::cos(theta), s * std::sin(phi)})
                mesh.positions.push_back(static_cast<float>(x));
        }
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(rows); ++i)
        for (std::uint32_t j = 0; j < columns; ++j) {
            const std::uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns;
            for (const std::uint32_t corner : {a, b, a + columns, b, b + columns, a + columns})
                mesh.indices.push_back(corner);
        }
    return mesh;
}

/// The reference study (tools/examples/reference-study.toml) with what `study` changes.
Scene scene_of(const Study& study) {
    Scene scene;
    scene.film.width = scene.film.height = study.side;
    scene.camera.origin = {0, 2.2, 6};
    scene.camera.target = {0, 0.9, 0};
    scene.integrator.max_depth = study.depth;
    const int side = static_cast<int>(std::ceil(std::sqrt(study.lights)));
    for (int i = 0; i < study.lights; ++i) {
        const double step = 2.0 / side;
        scene.lights.push_back(
            RectangleLight{{-3.0 + (i % side + 0.5) * step, 5.0, 0.5 + (i / side + 0.5) * step},
                           {step, 0, 0},
                           {0, 0, step},
                           Spectrum::constant(8.0)});
    }
    scene.lights.push_back(EnvironmentLight{Spectrum::constant(0.3)});
    Material ground;
    ground.name = "ground";
    ground.substrate.reflectance = Spectrum::constant(0.5);
    scene.materials = {paint(study), ground};
    Shape sphere{SphereShape{{0, 1, 0}, 1.0}, 0};
    if (study.sphere_rows > 0)
        sphere.geometry = sphere_mesh(study.sphere_rows);
    scene.shapes = {sphere, {RectangleShape{{0, 0, 0}, {20, 0, 0}, {0, 0, -20}}, 1}};
    scene.surfaces = plain_surfaces(scene);
    return scene;
}

double peak_kilobytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss);
}

void run(benchmark::State& state, const Study& study) {
    const Scene scene = scene_of(study);
    RenderOptions options;
    options.samples = 16;
    options.bands = WavelengthGrid{380, 400.0 / study.bands, study.bands};
    render(scene, device(), options); // builds kernels and tables that are kept
    RenderResult result;
    double seconds = 0.0, paths = 0.0;
    for (auto _ : state) {
        result = render(scene, device(), options);
        seconds += result.passes.back().seconds;
        paths += static_cast<double>(result.paths);
    }
    state.counters["Mpaths/s"] = 1e-6 * paths / seconds;
    state.counters["setup_s"] = result.setup_seconds;
    state.counters["rays/path"] =
        static_cast<double>(result.rays) / static_cast<double>(result.paths);
    state.counters["device_MB"] = 1e-6 * static_cast<double>(result.device_bytes);
    state.counters["peak_MB"] = 1e-3 * peak_kilobytes(); // the peak of the process so far
}

int argument(const benchmark::State& state) {
    return static_cast<int>(state.range(0));
}

void bands(benchmark::State& state) {
    run(state, {.bands = argument(state)});
}
void rank(benchmark::State& state) {
    run(state, {.rank = argument(state)});
}
void smooth_layers(benchmark::State& state) {
    run(state, {.layers = argument(state)});
}
void rough_layers(benchmark::State& state) {
    run(state, {.layers = argument(state), .alpha = 0.2});
}
void depth(benchmark::State& state) {
    run(state, {.depth = argument(state)});
}
void pixels(benchmark::State& state) {
    run(state, {.bands = 16, .side = argument(state)});
}
void lights(benchmark::State& state) {
    run(state, {.bands = 16, .lights = argument(state)});
}
void triangles(benchmark::State& state) {
    const int rows = static_cast<int>(std::lround(std::sqrt(argument(state) / 4.0)));
    run(state, {.bands = 16, .sphere_rows = rows});
}

} // namespace

BENCHMARK(bands)->Arg(16)->Arg(32)->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond);
BENCHMARK(rank)->DenseRange(0, 4)->Unit(benchmark::kMillisecond);
BENCHMARK(smooth_layers)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);
BENCHMARK(rough_layers)->DenseRange(1, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(depth)->Arg(1)->Arg(2)->Arg(4)->Arg(8)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK(pixels)->Arg(128)->Arg(256)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(lights)->Arg(1)->Arg(100)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(triangles)->Arg(1000)->Arg(100000)->Arg(1000000)->Arg(10000000)->Unit(
    benchmark::kMillisecond);

BENCHMARK_MAIN();
