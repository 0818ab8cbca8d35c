#pragma once

// Scenes of the walk's tests: materials side by side under one view.

#include "tests/render/test_scenes.h"
#include "tests/support/full_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace reradiant::test {

inline constexpr int strip_pixels = 16;
inline constexpr double view_deg = 50.0;
inline const WavelengthGrid bands = grid_from_range(400, 700, 20);

inline Layer rough(double ior, double alpha, Distribution distribution, Scattering scattering) {
    Layer result = layer(ior, alpha);
    result.distribution = distribution;
    result.scattering = scattering;
    return result;
}
inline Layer single(double ior, double alpha, Distribution distribution = Distribution::Ggx) {
    return rough(ior, alpha, distribution, Scattering::Single);
}

/// Absorbs more and more towards the red.
inline Layer tinted(Layer of) {
    of.absorption = Spectrum::table({400, 700}, {0.1, 1.0});
    return of;
}

/// Scatters more and more towards the red.
inline Layer clouded(Layer of, double g) {
    of.scattering_coefficient = Spectrum::table({400, 700}, {0.3, 1.5});
    of.anisotropy = g;
    return of;
}

inline double square(double x) {
    return x * x;
}

struct Stack {
    const char* name;
    std::vector<Layer> layers;
};

inline const std::vector<Stack> lossless_stacks = {
    {"bare", {}},
    {"smooth", {layer(1.5)}},
    {"rough 0.1", {layer(1.5, 0.1)}},
    {"rough 0.5", {layer(1.5, 0.5)}},
    {"beckmann 0.3, n 2", {rough(2.0, 0.3, Distribution::Beckmann, Scattering::Multiple)}},
    {"two smooth", {layer(1.8), layer(1.3)}},
    {"smooth over rough", {layer(1.3), layer(1.7, 0.3)}},
    {"rough over smooth", {layer(1.6, 0.3), layer(1.2)}},
    {"rough over rough", {layer(1.3, 0.2), layer(1.6, 0.4)}}};

inline std::vector<Stack> all_stacks() {
    std::vector<Stack> stacks = lossless_stacks;
    stacks.push_back({"single 0.1", {single(1.5, 0.1)}});
    stacks.push_back({"single 0.5", {single(1.5, 0.5)}});
    stacks.push_back({"single blinn 0.3", {single(1.5, 0.3, Distribution::Blinn)}});
    stacks.push_back({"tinted smooth", {tinted(layer(1.5))}});
    stacks.push_back({"tinted rough 0.3", {tinted(layer(1.5, 0.3))}});
    stacks.push_back({"tinted over clear", {tinted(layer(1.6)), layer(1.3, 0.2)}});
    stacks.push_back({"clouded", {clouded(layer(1.5), 0.0)}});
    stacks.push_back({"clouded forwards, rough", {clouded(layer(1.4, 0.3), 0.7)}});
    stacks.push_back(
        {"clouded and tinted over smooth", {tinted(clouded(layer(1.5), -0.3)), layer(1.2)}});
    return stacks;
}

/// Materials side by side on the plane y = 0, one strip of square tiles each, all seen under
/// `angle` by a camera whose angle is so narrow that the direction hardly varies.
inline Scene strips_scene(const std::vector<Material>& materials, double angle = view_deg) {
    const int count = static_cast<int>(materials.size());
    Scene scene = plane_scene(materials.front(), angle, strip_pixels * count, strip_pixels);
    scene.camera.up = {0, 1, 0}; // the film's rows then run along -z
    scene.materials = materials;
    scene.shapes.resize(materials.size());
    const double width = 20.0 * std::tan(0.005 * std::numbers::pi / 180.0);
    for (int i = 0; i < count; ++i) {
        Shape& shape = scene.shapes[static_cast<std::size_t>(i)];
        shape.geometry =
            RectangleShape{{0, 0, (0.5 * count - 0.5 - i) * width}, {0, 0, width}, {1000, 0, 0}};
        shape.material = i;
    }
    return scene;
}

/// Mean of a strip in one band, with its standard error.
inline BandStatistics strip_statistics(const SpectralImage& image, int strip, int band) {
    double sum = 0.0, squares = 0.0;
    constexpr double n = strip_pixels * strip_pixels;
    for (int i = 0; i < strip_pixels * strip_pixels; ++i) {
        const double v = static_cast<double>(
            image.at(strip * strip_pixels + i % strip_pixels, i / strip_pixels, band));
        sum += v;
        squares += v * v;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(squares / n - mean * mean, 0.0) / (n - 1.0))};
}

inline Material over_grey(std::vector<Layer> layers) {
    return material(std::move(layers), 0.7);
}
inline Material over_fluorescent(std::vector<Layer> layers) {
    return fluorescent(std::move(layers), shifted_matrix());
}
inline Material gold_under(std::vector<Layer> layers, double alpha) {
    Material result = material(std::move(layers), 0.0);
    result.substrate.type = SubstrateType::Conductor;
    result.substrate.conductor.ior = Spectrum::table({400, 700}, {1.5, 0.2});
    result.substrate.conductor.kappa = Spectrum::table({400, 700}, {1.9, 4.0});
    result.substrate.conductor.alpha = alpha;
    return result;
}
inline Material plaster_under(std::vector<Layer> layers) {
    Material result = material(std::move(layers), 0.8);
    result.substrate.type = SubstrateType::OrenNayar;
    result.substrate.sigma = 0.5;
    return result;
}

/// Renders of the walk get a few more materials and lights that cannot be seen, so that all of them
/// need the same features: kernels take seconds to build.
inline void add_what_is_not_seen(Scene& scene) {
    scene.lights.push_back(directional(0.0, 0.0, Spectrum()));
    scene.lights.push_back(RectangleLight{{0, 99, 0}, {1, 0, 0}, {0, 0, 1}, Spectrum()});
    scene.lights.push_back(environment(Spectrum::constant(1e-30)));
    for (const Material& unseen :
         {gold_under({}, 0.0), plaster_under({}),
          over_fluorescent({clouded(layer(1.5), 0.0), layer(1.4), layer(1.3)})}) {
        scene.materials.push_back(unseen);
        Shape& shape = scene.shapes.emplace_back();
        shape.geometry = SphereShape{{0, -50, 0}, 1.0};
        shape.material = static_cast<int>(scene.materials.size()) - 1;
    }
}

struct Lighting {
    std::vector<Light> lights;
    std::vector<Image> images = {};
};

inline RenderResult render_strips(const std::vector<Material>& materials, const Lighting& lighting,
                                  Model model, std::uint32_t samples, RenderOptions options = {}) {
    Scene scene = strips_scene(materials);
    scene.lights = lighting.lights;
    scene.images = lighting.images;
    scene.integrator.max_depth = 1;
    if (model == Model::Walk)
        add_what_is_not_seen(scene);
    options.bands = bands;
    options.samples = is_full_run() ? 16 * samples : samples;
    options.model = model;
    options.wavelengths.centred = true;
    return render(scene, device(), options);
}

inline const Lighting sun = {{directional(35.0, 60.0, Spectrum::constant(1.0))}};
inline const Lighting sky = {{environment(Spectrum::constant(1.0))}};
/// The same sky as an image, which is looked for.
inline Lighting sky_image() {
    Image white;
    white.width = 2;
    white.height = 2;
    white.rgb.assign(12, 1.0f);
    EnvironmentLight image{Spectrum::constant(1.0)};
    image.image = 0;
    return {{image}, {white}};
}
/// About as bright as each other; the first area light stands where smooth stacks mirror it.
inline const Lighting every_light = {
    {directional(35.0, 60.0, Spectrum::constant(1.0)), environment(Spectrum::constant(0.5)),
     RectangleLight{{-8, 7, 0}, {0, 2, 0}, {0, 0, 2}, Spectrum::constant(9.0)},
     SphereLight{{4, 4, 3}, 0.7, Spectrum::constant(9.0)}}};

/// Comparisons in all of the walk's tests, about.
inline constexpr int comparisons = 2000;

} // namespace reradiant::test
