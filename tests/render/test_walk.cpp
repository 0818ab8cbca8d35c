#include "host/error.h"
#include "host/layers/walk_estimate.h"
#include "host/render/scene_tables.h"
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
constexpr double view_deg = 50.0;
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

const std::vector<Stack> lossless_stacks = {
    {"bare", {}},
    {"smooth", {layer(1.5)}},
    {"rough 0.1", {layer(1.5, 0.1)}},
    {"rough 0.5", {layer(1.5, 0.5)}},
    {"beckmann 0.3, n 2", {rough(2.0, 0.3, Distribution::Beckmann, Scattering::Multiple)}},
    {"two smooth", {layer(1.8), layer(1.3)}},
    {"smooth over rough", {layer(1.3), layer(1.7, 0.3)}},
    {"rough over smooth", {layer(1.6, 0.3), layer(1.2)}},
    {"rough over rough", {layer(1.3, 0.2), layer(1.6, 0.4)}}};

std::vector<Stack> all_stacks() {
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
/// view_deg by a camera whose angle is so narrow that the direction hardly varies.
Scene strips_scene(const std::vector<Material>& materials) {
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

Material over_grey(std::vector<Layer> layers) {
    return material(std::move(layers), 0.7);
}
Material over_fluorescent(std::vector<Layer> layers) {
    return fluorescent(std::move(layers), shifted_matrix());
}
Material gold_under(std::vector<Layer> layers, double alpha) {
    Material result = material(std::move(layers), 0.0);
    result.substrate.type = SubstrateType::Conductor;
    result.substrate.conductor.ior = Spectrum::table({400, 700}, {1.5, 0.2});
    result.substrate.conductor.kappa = Spectrum::table({400, 700}, {1.9, 4.0});
    result.substrate.conductor.alpha = alpha;
    return result;
}
Material plaster_under(std::vector<Layer> layers) {
    Material result = material(std::move(layers), 0.8);
    result.substrate.type = SubstrateType::OrenNayar;
    result.substrate.sigma = 0.5;
    return result;
}

/// Renders of the walk get a few more materials and lights that cannot be seen, so that all of them
/// need the same features: kernels take seconds to build.
void add_what_is_not_seen(Scene& scene) {
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

RenderResult render_strips(const std::vector<Material>& materials, const Lighting& lighting,
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

const Lighting sun = {{directional(35.0, 60.0, Spectrum::constant(1.0))}};
const Lighting sky = {{environment(Spectrum::constant(1.0))}};
/// About as bright as each other; the first area light stands where smooth stacks mirror it.
const Lighting every_light = {
    {directional(35.0, 60.0, Spectrum::constant(1.0)), environment(Spectrum::constant(0.5)),
     RectangleLight{{-8, 7, 0}, {0, 2, 0}, {0, 0, 2}, Spectrum::constant(9.0)},
     SphereLight{{4, 4, 3}, 0.7, Spectrum::constant(9.0)}}};

struct Comparison {
    const char* name;
    int band;
    double difference = 0.0, variance = 0.0, size = 0.0;

    void add(const BandStatistics& s, double sign) {
        difference += sign * s.mean;
        variance += s.standard_error * s.standard_error;
        size = std::max(size, s.mean);
    }
    /// The tables of rough interfaces are sampled themselves, to about 0.1 %.
    void expect_equal(double sigmas) const {
        EXPECT_NEAR(difference, 0.0, sigmas * std::sqrt(variance) + 1e-3 * size)
            << name << ", band " << band << " of " << size << ", standard error "
            << std::sqrt(variance);
    }
};

/// Comparisons in this file, about.
constexpr int comparisons = 2000;

/// What stacks show over a re-radiating substrate less what they show over a black one: `adding`
/// has that exactly in every direction, while it spreads over directions what rough stacks reflect
/// themselves. Smooth stacks are compared as they are, too.
void expect_agreement_with_adding(const Lighting& lighting, std::uint32_t samples) {
    const std::vector<Stack> stacks = all_stacks();
    std::vector<Material> materials;
    for (const Stack& stack : stacks)
        materials.push_back(over_fluorescent(stack.layers));
    for (const Stack& stack : stacks)
        materials.push_back(material(stack.layers, 0.0));
    RenderOptions other_seed;
    other_seed.seed = 1;
    const RenderResult walk = render_strips(materials, lighting, Model::Walk, samples);
    const RenderResult adding =
        render_strips(materials, lighting, Model::Adding, samples, other_seed);
    EXPECT_EQ(walk.non_finite, 0u);
    const int count = static_cast<int>(stacks.size());
    for (int i = 0; i < count; ++i)
        for (int band = 0; band < bands.count; ++band) {
            const Stack& stack = stacks[static_cast<std::size_t>(i)];
            Comparison all{stack.name, band};
            all.add(strip_statistics(walk.image, i, band), 1.0);
            all.add(strip_statistics(adding.image, i, band), -1.0);
            Comparison less_black = all;
            less_black.add(strip_statistics(walk.image, i + count, band), -1.0);
            less_black.add(strip_statistics(adding.image, i + count, band), 1.0);
            less_black.expect_equal(sidak_sigmas(comparisons));
            const bool is_smooth = material(stack.layers, 0.0).stack.is_smooth();
            if (is_smooth && !stack.layers.empty() && !stack.layers.front().scatters())
                all.expect_equal(sidak_sigmas(comparisons));
        }
}

TEST(Walk, AgreesWithAddingUnderEveryLight) {
    expect_agreement_with_adding(every_light, 128);
}
TEST(Walk, AgreesWithAddingUnderEachLight) {
    if (!is_full_run())
        GTEST_SKIP() << "in the full run only: each light by itself";
    for (const Light& light : every_light.lights)
        expect_agreement_with_adding({{light}}, 128);
}

/// A white furnace is white: a walk that neither absorbs nor loses returns all of what it finds.
TEST(Walk, WhiteFurnaceIsWhite) {
    std::vector<Stack> stacks = lossless_stacks;
    Layer cloud = layer(1.5, 0.2);
    cloud.scattering_coefficient = Spectrum::constant(2.0);
    cloud.anisotropy = 0.9;
    stacks.push_back({"cloud", {cloud}});
    std::vector<Material> materials;
    for (const Stack& stack : stacks)
        materials.push_back(material(stack.layers, 1.0));
    const RenderResult result = render_strips(materials, sky, Model::Walk, 64);
    EXPECT_EQ(result.non_finite, 0u);
    for (std::size_t i = 0; i < stacks.size(); ++i) {
        const BandStatistics found = strip_statistics(result.image, static_cast<int>(i), 5);
        // exact but for roulette of very long walks, and rounding
        EXPECT_NEAR(found.mean, 1.0, 1e-5 + sidak_sigmas(comparisons) * found.standard_error)
            << stacks[i].name;
        EXPECT_LT(found.standard_error, 1e-3) << stacks[i].name;
    }
}

/// Materials that adding has not, or has only on the average over directions.
std::vector<Material> materials_for_the_twin() {
    Material foil =
        gold_under({tinted(rough(1.4, 0.3, Distribution::Beckmann, Scattering::Single))}, 0.4);
    foil.substrate.conductor.scattering = Scattering::Single;
    foil.substrate.conductor.distribution = Distribution::Blinn;
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
            gold_under({layer(1.5, 0.2)}, 0.4),
            foil,
            gold_under({layer(1.5, 0.2)}, 0.0),
            plaster_under({layer(1.3, 0.2)})};
}

SubstrateValues twin_substrate(const Substrate& substrate, const std::vector<double>& nm) {
    SubstrateValues twin;
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
    const RenderResult result = render_strips(materials, sun, Model::Walk, 128);
    const auto direction = [](double theta_deg, double phi_deg) {
        const double radian = std::numbers::pi / 180.0, s = std::sin(theta_deg * radian);
        return kernels::vec3(s * std::cos(phi_deg * radian), s * std::sin(phi_deg * radian),
                             std::cos(theta_deg * radian));
    };
    const kernels::Vec3 wi = direction(35.0, 60.0);
    const std::vector<kernels::Vec3> wo = {direction(view_deg, 0.0)};
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
            EXPECT_NEAR(found.mean, expected, sidak_sigmas(comparisons) * error + 2e-4 * expected)
                << "material " << m << ", band " << compared[b] << ", standard error " << error;
        }
    }
}

/// An environment that is an image is looked for, a constant one is found by chance: two
/// estimators of the same radiance that share nothing but the walk.
TEST(Walk, LightsLookedForAndLightsFoundAgree) {
    std::vector<Material> materials = materials_for_the_twin();
    for (const Stack& stack : all_stacks())
        materials.push_back(over_fluorescent(stack.layers));
    const RenderResult found = render_strips(materials, sky, Model::Walk, 64);
    Image white;
    white.width = 2;
    white.height = 2;
    white.rgb.assign(12, 1.0f);
    EnvironmentLight image{Spectrum::constant(1.0)};
    image.image = 0;
    const RenderResult looked_for = render_strips(materials, {{image}, {white}}, Model::Walk, 128);
    for (std::size_t m = 0; m < materials.size(); ++m)
        for (const int band : {2, 13}) {
            const BandStatistics a = strip_statistics(found.image, static_cast<int>(m), band);
            const BandStatistics b = strip_statistics(looked_for.image, static_cast<int>(m), band);
            const double error = std::hypot(a.standard_error, b.standard_error);
            // the basis of rgb spectra adds up to one to single precision
            EXPECT_NEAR(a.mean, b.mean, sidak_sigmas(comparisons) * error + 1e-5)
                << "material " << m << ", band " << band << ", standard error " << error;
        }
}

std::vector<float> rendered(std::size_t batch_paths, unsigned seed) {
    RenderOptions options;
    options.batch_paths = batch_paths;
    options.seed = seed;
    return render_strips({over_fluorescent({tinted(layer(1.5, 0.2)), layer(1.3)})}, every_light,
                         Model::Walk, 9, options)
        .image.values;
}

TEST(Walk, SameSeedGivesTheSameImageWhateverTheBatch) {
    // batches of every size begin with too little room for events
    const std::vector<float> reference = rendered(1u << 15, 0);
    EXPECT_EQ(rendered(300, 0), reference);
    EXPECT_NE(rendered(1u << 15, 1), reference);
}

TEST(Walk, LeavesNothingWhereNoMaterialAsksForIt) {
    Scene scene = strips_scene({over_grey({layer(1.5)})});
    scene.lights = sun.lights;
    const WavelengthPlan plan = plan_wavelengths(scene, bands, {});
    const SceneTables without = build_scene_tables(scene, plan, Model::Auto, false);
    EXPECT_FALSE(without.features.walk);
    EXPECT_TRUE(without.walk_parts.empty());
    const std::vector<std::string> lines = without.features.left_out();
    EXPECT_NE(std::find(lines.begin(), lines.end(), "walk: no material uses the model walk"),
              lines.end());
    scene.materials.front().model = Model::Walk;
    const SceneTables with = build_scene_tables(scene, plan, Model::Auto, false);
    EXPECT_TRUE(with.features.walk);
    EXPECT_EQ(with.walk_parts.size(), 2u);
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
