#include "host/error.h"
#include "tests/full_run.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

using namespace test;

constexpr int strip_pixels = 16;
const WavelengthGrid bands = grid_from_range(400, 700, 20);

Layer rough(double ior, double alpha, Distribution distribution, Scattering scattering) {
    Layer result = layer(ior, alpha);
    result.distribution = distribution;
    result.scattering = scattering;
    return result;
}
Layer single(double ior, double alpha, Distribution distribution = Distribution::Ggx) {
    return rough(ior, alpha, distribution, Scattering::Single);
}

/// Absorbs more and more towards the red.
Layer tinted(Layer of) {
    of.absorption = Spectrum::table({400, 700}, {0.1, 1.0});
    return of;
}

/// Scatters more and more towards the red.
Layer clouded(Layer of, double g) {
    of.scattering_coefficient = Spectrum::table({400, 700}, {0.3, 1.5});
    of.anisotropy = g;
    return of;
}

struct Stack {
    const char* name;
    std::vector<Layer> layers;
};

const std::vector<Stack> clear_stacks = {
    {"bare", {}},
    {"smooth", {layer(1.5)}},
    {"rough 0.1", {layer(1.5, 0.1)}},
    {"rough 0.5", {layer(1.5, 0.5)}},
    {"beckmann 0.3, n 2", {rough(2.0, 0.3, Distribution::Beckmann, Scattering::Multiple)}},
    {"single 0.1", {single(1.5, 0.1)}},
    {"single 0.5", {single(1.5, 0.5)}},
    {"single blinn 0.3", {single(1.5, 0.3, Distribution::Blinn)}},
    {"two smooth", {layer(1.8), layer(1.3)}},
    {"smooth over rough", {layer(1.3), layer(1.7, 0.3)}},
    {"rough over smooth", {layer(1.6, 0.3), layer(1.2)}},
    {"rough over rough", {layer(1.3, 0.2), layer(1.6, 0.4)}}};

const std::vector<Stack> absorbing_stacks = {
    {"tinted smooth", {tinted(layer(1.5))}},
    {"tinted rough 0.3", {tinted(layer(1.5, 0.3))}},
    {"tinted over clear", {tinted(layer(1.6)), layer(1.3, 0.2)}}};

const std::vector<Stack> scattering_stacks = {
    {"clouded", {clouded(layer(1.5), 0.0)}},
    {"clouded forwards, rough", {clouded(layer(1.4, 0.3), 0.7)}},
    {"clouded and tinted over smooth", {tinted(clouded(layer(1.5), -0.3)), layer(1.2)}}};

/// Materials side by side on the plane y = 0, one strip of square tiles each, all seen under
/// `view_deg` by a camera whose angle is so narrow that the direction hardly varies.
Scene strips_scene(const std::vector<Material>& materials, double view_deg) {
    const int count = static_cast<int>(materials.size());
    Scene scene = plane_scene(materials.front(), view_deg, strip_pixels * count, strip_pixels);
    scene.camera.up = {0, 1, 0}; // the film's rows then run along -z
    scene.materials = materials;
    scene.shapes.resize(materials.size());
    const double width = 20.0 * std::tan(0.005 * std::numbers::pi / 180.0);
    for (int i = 0; i < count; ++i) {
        Shape& shape = scene.shapes[static_cast<std::size_t>(i)];
        shape.geometry = RectangleShape{
            {0, 0, (0.5 * count - 0.5 - i) * width}, {0, 0, width}, {1000, 0, 0}};
        shape.material = i;
    }
    return scene;
}

/// Mean of a strip in one band, with its standard error.
BandStatistics strip_statistics(const SpectralImage& image, int strip, int band) {
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

RenderResult render_strips(const std::vector<Material>& materials, const std::vector<Light>& lights,
                           Model model, std::uint32_t samples, double view_deg = 50.0) {
    Scene scene = strips_scene(materials, view_deg);
    scene.lights = lights;
    scene.integrator.max_depth = 1;
    RenderOptions options;
    options.bands = bands;
    options.samples = is_full_run() ? 16 * samples : samples;
    options.model = model;
    options.wavelengths.centred = true;
    options.seed = model == Model::Walk ? 1 : 2;
    return render(scene, device(), options);
}

/// Every stack over the substrates that `over` makes, then every one over a black one. Film band
/// means of the two models, once as they are or less what the black substrate shows (`adding` has
/// the stack's own reflection exactly in all directions together only), within Sidak's bound.
void expect_agreement(const std::vector<Stack>& stacks, const std::vector<Light>& lights,
                      bool less_black, std::uint32_t samples,
                      Material (*over)(std::vector<Layer>)) {
    std::vector<Material> materials;
    for (const Stack& stack : stacks)
        materials.push_back(over(stack.layers));
    for (const Stack& stack : stacks)
        materials.push_back(material(stack.layers, 0.0));
    const RenderResult walk = render_strips(materials, lights, Model::Walk, samples);
    const RenderResult adding = render_strips(materials, lights, Model::Adding, samples);
    EXPECT_EQ(walk.non_finite, 0u);
    const int count = static_cast<int>(stacks.size());
    const double sigmas = sidak_sigmas(2000); // about as many comparisons in this file
    for (int i = 0; i < count; ++i)
        for (int band = 0; band < bands.count; ++band) {
            double difference = 0.0, variance = 0.0, size = 0.0;
            for (const RenderResult* result : {&walk, &adding})
                for (const int strip : {i, i + count}) {
                    if (strip != i && !less_black)
                        continue;
                    const BandStatistics s = strip_statistics(result->image, strip, band);
                    const double sign = (result == &walk ? 1.0 : -1.0) * (strip == i ? 1.0 : -1.0);
                    difference += sign * s.mean;
                    variance += s.standard_error * s.standard_error;
                    size = std::max(size, s.mean);
                }
            if (band == 8 || band == 15) printf("%-32s band %d size %.5f diff %+.5f se %.5f (rel %.3f%%) z %.2f\n", stacks[(size_t)i].name, band, size, difference, std::sqrt(variance), 100*std::sqrt(variance)/size, difference/std::sqrt(variance));
            // the tables of rough interfaces are sampled themselves, to about 0.1 %
            EXPECT_NEAR(difference, 0.0, sigmas * std::sqrt(variance) + 1e-3 * size)
                << stacks[static_cast<std::size_t>(i)].name << ", band " << band << " of " << size
                << ", standard error " << std::sqrt(variance);
        }
}

Material over_grey(std::vector<Layer> layers) {
    return material(std::move(layers), 0.7);
}
Material over_fluorescent(std::vector<Layer> layers) {
    return fluorescent(std::move(layers), shifted_matrix());
}

const std::vector<Light> sun = {directional(35.0, 60.0, Spectrum::constant(1.0))};
const std::vector<Light> sky = {environment(Spectrum::constant(1.0))};

TEST(Walk, DirectionalLightOnDiffuseSubstrate) {
    expect_agreement(clear_stacks, sun, true, 32, over_grey);
}
TEST(Walk, DirectionalLightOnFluorescentSubstrate) {
    expect_agreement(absorbing_stacks, sun, true, 32, over_fluorescent);
}
TEST(Walk, EnvironmentOnDiffuseSubstrate) {
    expect_agreement(clear_stacks, sky, false, 32, over_grey);
}
TEST(Walk, EnvironmentOnFluorescentSubstrate) {
    expect_agreement(absorbing_stacks, sky, false, 32, over_fluorescent);
}
TEST(Walk, ScatteringSlabs) {
    expect_agreement(scattering_stacks, sky, false, 64, over_grey);
}

} // namespace
} // namespace reradiant
