#include "host/render/tables/scene_tables.h"
#include "reradiant/error.h"
#include "tests/render/walk_strips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace reradiant {
namespace {

using namespace test;

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

/// Compares the walk with `adding` by the radiance of stacks over a re-radiating substrate less
/// that of the same stacks over a black one: `adding` has that exactly in every direction, while it
/// spreads over directions what rough stacks reflect themselves. Smooth stacks are compared as they
/// are, too.
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
            less_black.expect_equal(test::sidak_bound(comparisons));
            const bool is_smooth = material(stack.layers, 0.0).stack.is_smooth();
            if (is_smooth && !stack.layers.empty() && !stack.layers.front().scatters())
                all.expect_equal(test::sidak_bound(comparisons));
        }
}

TEST(Walk, AgreesWithAddingUnderEveryLight) {
    expect_agreement_with_adding(every_light, 128);
}
TEST(Walk, AgreesWithAddingUnderEachLight) {
    if (!test::is_full_run())
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
    // what V-cavities give back is known by cells of direction, to 1e-3
    stacks.push_back({"blinn 0.4", {rough(1.5, 0.4, Distribution::Blinn, Scattering::Multiple)}});
    std::vector<Material> materials;
    for (const Stack& stack : stacks)
        materials.push_back(material(stack.layers, 1.0));
    const RenderResult result = render_strips(materials, sky, Model::Walk, 64);
    EXPECT_EQ(result.non_finite, 0u);
    for (std::size_t i = 0; i < stacks.size(); ++i) {
        const BandStatistics found = strip_statistics(result.image, static_cast<int>(i), 5);
        // exact but for roulette of very long walks, and rounding
        const bool is_blinn = i + 1 == stacks.size();
        const double known_to = is_blinn ? 1e-3 : 1e-5;
        EXPECT_NEAR(found.mean, 1.0,
                    known_to + test::sidak_bound(comparisons) * found.standard_error)
            << stacks[i].name;
        // every walk weighs 1, but those of V-cavities, whose facets are masked
        EXPECT_LT(found.standard_error, is_blinn ? 5e-3 : 1e-3) << stacks[i].name;
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

/// Strips of two materials, and of one whose surface mixes them or picks one of them as the levels
/// of a checker of many squares a pixel: the mean of the two.
TEST(Walk, MixturesAndTexturesAreTheMeanOfWhatTheyMix) {
    const std::vector<Material> materials = {gold_under({layer(1.5, 0.2)}, 0.3),
                                             over_fluorescent({layer(1.5)}), over_grey({}),
                                             over_grey({})};
    Scene scene = strips_scene(materials);
    scene.lights = {environment(Spectrum::constant(1.0))};
    scene.integrator.max_depth = 1;
    scene.surfaces = plain_surfaces(scene);
    scene.surfaces[2].first_material = 0;
    scene.surfaces[2].mixed_with = 1;
    scene.surfaces[2].mix_weight = 0.5;
    Texture checker;
    checker.type = TextureType::Checker;
    checker.space = TextureSpace::Uv;
    checker.size = 1e-6;
    checker.levels = 2;
    scene.textures = {checker};
    scene.surfaces[3].first_material = 0;
    scene.surfaces[3].textures = {0};
    RenderOptions options;
    options.bands = bands;
    options.samples = 256;
    options.model = Model::Walk;
    const RenderResult result = render(scene, device(), options);
    for (const int band : {2, 6, 13}) {
        const BandStatistics a = strip_statistics(result.image, 0, band);
        const BandStatistics b = strip_statistics(result.image, 1, band);
        EXPECT_GT(std::fabs(a.mean - b.mean), 0.02) << "the two tell apart, band " << band;
        for (const int strip : {2, 3}) {
            const BandStatistics mixed = strip_statistics(result.image, strip, band);
            EXPECT_NEAR(mixed.mean, 0.5 * (a.mean + b.mean),
                        test::sidak_bound(comparisons) * std::hypot(mixed.standard_error,
                                                                    0.5 * a.standard_error,
                                                                    0.5 * b.standard_error))
                << "strip " << strip << ", band " << band;
        }
    }
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
    RenderOptions options;
    options.bands = bands;
    const RenderPlan without = plan_render(scene, device().info(), options);
    EXPECT_FALSE(without.features.walk);
    EXPECT_TRUE(build_scene_tables(scene, without).walk_parts.empty());
    const std::vector<std::string> lines = without.left_out();
    EXPECT_NE(std::find(lines.begin(), lines.end(), "walk: no material uses the model walk"),
              lines.end());
    scene.materials.front().model = Model::Walk;
    const RenderPlan with = plan_render(scene, device().info(), options);
    EXPECT_TRUE(with.features.walk);
    EXPECT_EQ(build_scene_tables(scene, with).walk_parts.size(), 2u);
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
    expect_refusal(over_grey({dispersive}), "IOR that does not depend on wavelength");
    Layer film = layer(1.5);
    film.film = ThinFilm{};
    expect_refusal(over_grey({film}), "films");
    Layer flakes = layer(1.5);
    flakes.flakes = Flakes{};
    expect_refusal(over_grey({flakes}), "smooth flakes");
}

} // namespace
} // namespace reradiant
