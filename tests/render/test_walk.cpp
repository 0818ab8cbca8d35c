#include "host/error.h"
#include "host/layers/walk_estimate.h"
#include "tests/full_run.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

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

double square(double x) {
    return x * x;
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
        shape.geometry =
            RectangleShape{{0, 0, (0.5 * count - 0.5 - i) * width}, {0, 0, width}, {1000, 0, 0}};
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
                           Model model, std::uint32_t samples, double view_deg = 50.0,
                           std::vector<Image> images = {}) {
    Scene scene = strips_scene(materials, view_deg);
    scene.lights = lights;
    scene.images = std::move(images);
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

Material over_white(std::vector<Layer> layers) {
    return material(std::move(layers), 1.0);
}

constexpr double view = 50.0;
const std::vector<Light> sun = {directional(35.0, 60.0, Spectrum::constant(1.0))};
const std::vector<Light> sky = {environment(Spectrum::constant(1.0))};

TEST(Walk, DirectionalLightOnDiffuseSubstrate) {
    expect_agreement(clear_stacks, sun, true, 128, over_grey);
}
TEST(Walk, DirectionalLightOnFluorescentSubstrate) {
    expect_agreement(absorbing_stacks, sun, true, 128, over_fluorescent);
}
TEST(Walk, EnvironmentOnDiffuseSubstrate) {
    expect_agreement(clear_stacks, sky, false, 64, over_grey);
}
TEST(Walk, EnvironmentOnFluorescentSubstrate) {
    expect_agreement(absorbing_stacks, sky, false, 128, over_fluorescent);
}
TEST(Walk, ScatteringSlabs) {
    expect_agreement(scattering_stacks, sky, false, 128, over_grey);
}
TEST(Walk, AreaLightsOnDiffuseSubstrate) {
    const std::vector<Light> lights = {
        RectangleLight{{4, 5, 3}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(5.0)},
        RectangleLight{{-1, 4, -4}, {0, 2, 0}, {2, 0, 0}, Spectrum::constant(5.0)},
        SphereLight{{-3, 4, 1}, 0.5, Spectrum::constant(9.0)}};
    expect_agreement(clear_stacks, lights, true, 128, over_grey);
}

TEST(Walk, SmoothStacksMirrorAreaLights) {
    // in the mirror's direction: found by the camera's own walk, all events being deltas
    const std::vector<Light> lights = {RectangleLight{
        {-8, 7, 0}, {0, 2, 0}, {0, 0, 2}, Spectrum::constant(2.0)}}; // emits towards +x
    const std::vector<Stack> stacks = {{"smooth", {layer(1.5)}},
                                       {"two smooth", {layer(1.8), layer(1.3)}},
                                       {"tinted", {tinted(layer(1.5)), layer(2.0)}}};
    expect_agreement(stacks, lights, false, 256, over_grey);
}

/// A white furnace is white: a walk that neither absorbs nor loses returns all of what it finds.
TEST(Walk, WhiteFurnaceIsWhite) {
    std::vector<Stack> stacks;
    for (const Stack& stack : clear_stacks)
        if (std::string(stack.name).find("single") == std::string::npos)
            stacks.push_back(stack);
    Layer cloud = layer(1.5, 0.2);
    cloud.scattering_coefficient = Spectrum::constant(2.0);
    cloud.anisotropy = 0.9;
    stacks.push_back({"cloud", {cloud}});
    std::vector<Material> materials;
    for (const Stack& stack : stacks)
        materials.push_back(over_white(stack.layers));
    const RenderResult result = render_strips(materials, sky, Model::Walk, 64);
    EXPECT_EQ(result.non_finite, 0u);
    for (std::size_t i = 0; i < stacks.size(); ++i) {
        const BandStatistics found = strip_statistics(result.image, static_cast<int>(i), 5);
        // exact but for roulette of very long walks, and rounding
        EXPECT_NEAR(found.mean, 1.0, 1e-5 + sidak_sigmas(2000) * found.standard_error)
            << stacks[i].name;
        EXPECT_LT(found.standard_error, 1e-3) << stacks[i].name;
    }
}

/// Materials that adding has not, or has only on the average over directions.
std::vector<Material> materials_for_the_twin() {
    Material gold = material({layer(1.5, 0.2)}, 0.0);
    gold.substrate.type = SubstrateType::Conductor;
    gold.substrate.conductor.ior = Spectrum::table({400, 700}, {1.5, 0.2});
    gold.substrate.conductor.kappa = Spectrum::table({400, 700}, {1.9, 4.0});
    gold.substrate.conductor.alpha = 0.4;
    Material foil = gold;
    foil.stack.layers = {tinted(rough(1.4, 0.3, Distribution::Beckmann, Scattering::Single))};
    foil.substrate.conductor.scattering = Scattering::Single;
    foil.substrate.conductor.distribution = Distribution::Blinn;
    Material mirror = gold;
    mirror.substrate.conductor.alpha = 0.0;
    Material plaster = material({layer(1.3, 0.2)}, 0.8);
    plaster.substrate.type = SubstrateType::OrenNayar;
    plaster.substrate.sigma = 0.5;
    Layer cloud = layer(1.4, 0.2, 0.2);
    cloud.scattering_coefficient = Spectrum::constant(1.5);
    cloud.anisotropy = 0.6;
    return {over_grey({layer(1.5, 0.5)}),
            over_grey({rough(2.0, 0.3, Distribution::Beckmann, Scattering::Multiple)}),
            over_grey({single(1.5, 0.3, Distribution::Blinn)}),
            over_grey({layer(1.6, 0.3), layer(1.2)}),
            over_grey({layer(1.3), layer(1.6, 0.4), layer(1.3, 0.2)}),
            over_grey({cloud}),
            over_grey({cloud, layer(1.8, 0.1), layer(1.2)}),
            gold,
            foil,
            mirror,
            plaster};
}

WalkSubstrate twin_substrate(const Substrate& substrate, const std::vector<double>& nm) {
    WalkSubstrate twin;
    const auto count = static_cast<Eigen::Index>(nm.size());
    twin.matrix = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
        twin.matrix(i, i) = substrate.reflectance(nm[static_cast<std::size_t>(i)]);
    twin.sigma = substrate.sigma;
    if (substrate.type == SubstrateType::Conductor)
        for (const double wavelength : nm)
            twin.conductor.push_back(conductor_at(substrate.conductor, wavelength));
    return twin;
}

TEST(Walk, MatchesTheDoublePrecisionWalkInAngle) {
    const std::vector<Material> materials = materials_for_the_twin();
    const RenderResult result = render_strips(materials, sun, Model::Walk, 128, view);
    const auto direction = [](double theta_deg, double phi_deg) {
        const double radian = std::numbers::pi / 180.0, s = std::sin(theta_deg * radian);
        return kernels::vec3(s * std::cos(phi_deg * radian), s * std::sin(phi_deg * radian),
                             std::cos(theta_deg * radian));
    };
    const kernels::Vec3 wi = direction(35.0, 60.0);
    const std::vector<kernels::Vec3> wo = {direction(view, 0.0)};
    const std::vector<int> compared = {2, 13};
    const std::vector<double> nm = {bands.centre_nm(2), bands.centre_nm(13)};
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const LayerWalk walk(materials[m].stack, twin_substrate(materials[m].substrate, nm), nm);
        const WalkEstimate twin =
            estimate_walk(walk, wi, wo, is_full_run() ? 1u << 20 : 1u << 14, 3);
        for (std::size_t b = 0; b < nm.size(); ++b) {
            const auto row = static_cast<Eigen::Index>(b);
            const auto sum_of = [&](const WalkTally::Parts& parts, bool squared) {
                const double diffuse = parts.diffuse.row(row).sum(), rest = parts.specular(row);
                return squared ? diffuse * diffuse + rest * rest : diffuse + rest;
            };
            const double expected = sum_of(twin.mean.directional[0], false) * wi.z;
            const double variance = sum_of(twin.standard_error.directional[0], true) * wi.z * wi.z;
            const BandStatistics found =
                strip_statistics(result.image, static_cast<int>(m), compared[b]);
            const double error = std::sqrt(square(found.standard_error) + variance);
            EXPECT_NEAR(found.mean, expected, sidak_sigmas(2000) * error + 2e-4 * expected)
                << "material " << m << ", band " << compared[b] << ", standard error " << error;
        }
    }
}

/// An environment that is an image is looked for, a constant one is found by chance: two
/// estimators of the same radiance that share nothing but the walk.
TEST(Walk, LightsLookedForAndLightsFoundAgree) {
    std::vector<Material> materials = materials_for_the_twin();
    for (const Stack& stack : scattering_stacks)
        materials.push_back(over_fluorescent(stack.layers));
    const RenderResult found = render_strips(materials, sky, Model::Walk, 128, view);
    Image white;
    white.width = 2;
    white.height = 2;
    white.rgb.assign(12, 1.0f);
    EnvironmentLight image{Spectrum::constant(1.0)};
    image.image = 0;
    const RenderResult looked_for =
        render_strips(materials, {image}, Model::Walk, 256, view, {white});
    for (std::size_t m = 0; m < materials.size(); ++m)
        for (const int band : {2, 13}) {
            const BandStatistics a = strip_statistics(found.image, static_cast<int>(m), band);
            const BandStatistics b = strip_statistics(looked_for.image, static_cast<int>(m), band);
            const double error = std::hypot(a.standard_error, b.standard_error);
            // the basis of rgb spectra adds up to one to single precision
            EXPECT_NEAR(a.mean, b.mean, sidak_sigmas(2000) * error + 1e-5)
                << "material " << m << ", band " << band << ", standard error " << error;
        }
}

std::vector<float> rendered(std::size_t batch_paths, std::uint32_t seed) {
    Scene scene =
        sphere_scene(fluorescent({tinted(layer(1.5, 0.2)), layer(1.3)}, shifted_matrix()), 12, 10);
    scene.lights = {environment(Spectrum::constant(0.3)),
                    RectangleLight{{0, 4, 1}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(5.0)}};
    RenderOptions options;
    options.model = Model::Walk;
    options.samples = 9;
    options.batch_paths = batch_paths;
    options.seed = seed;
    return render(scene, device(), options).image.values;
}

TEST(Walk, SameSeedGivesTheSameImageWhateverTheBatch) {
    const std::vector<float> reference = rendered(1u << 15, 0);
    EXPECT_EQ(rendered(13, 0), reference);
    EXPECT_EQ(rendered(300, 0), reference);
    EXPECT_NE(rendered(300, 1), reference);
}

TEST(Walk, LeavesNothingWhereNoMaterialAsksForIt) {
    const Material plain = over_grey({layer(1.5)});
    Material walked = plain;
    walked.model = Model::Walk;
    const RenderResult without = render_strips({plain}, sun, Model::Auto, 1);
    const RenderResult with = render_strips({walked}, sun, Model::Auto, 1);
    EXPECT_FALSE(without.features.at("walk"));
    EXPECT_TRUE(with.features.at("walk"));
    EXPECT_NE(std::find(without.left_out.begin(), without.left_out.end(),
                        "walk: no material uses the model walk"),
              without.left_out.end());
    EXPECT_LT(without.device_bytes, with.device_bytes);
}

void expect_refusal(const Material& refused, const char* text) {
    try {
        render_strips({refused}, sun, Model::Walk, 1);
        FAIL() << text;
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2);
        EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
}

TEST(Walk, RefusesWhatItHasNot) {
    Layer dispersive = layer(1.5);
    dispersive.ior = Spectrum::table({400, 700}, {1.6, 1.5});
    expect_refusal(over_grey({dispersive}), "IOR does not depend on wavelength");
    Layer film = layer(1.5);
    film.film = ThinFilm{};
    expect_refusal(over_grey({film}), "films");
    Layer flakes = layer(1.5);
    flakes.flakes = Flakes{};
    expect_refusal(over_grey({flakes}), "flakes");
    expect_refusal(over_grey({rough(1.5, 0.2, Distribution::Blinn, Scattering::Multiple)}),
                   "V-cavities");
}

} // namespace
} // namespace reradiant
