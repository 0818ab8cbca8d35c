// Scenes of random materials: nothing that is not a number, nothing negative, and no energy from
// nowhere. Programs are built with every feature on, so that they are built once.
#include "tests/render/random_materials.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace reradiant {
namespace {

using namespace test;

Light random_light(RandomMaterials& random) {
    const double power = random.edge_or_between({1e-6, 1.0, 1e4});
    switch (random.integer(5)) {
    case 0:
        return RectangleLight{{0, 3, 1}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(power)};
    case 1:
        return SphereLight{
            {2, 2, 2}, random.edge_or_between({1e-4, 0.5}), Spectrum::constant(power)};
    case 2:
        return PointLight{{-2, 2, 2}, Spectrum::constant(power)};
    case 3:
        return directional(random.edge_or_between({0.0, 60.0, 89.999}), 30.0,
                           Spectrum::constant(power));
    default:
        return environment(Spectrum::constant(power));
    }
}

Scene random_scene(RandomMaterials& random, const Material& material) {
    Scene scene = sphere_scene(material, 6, 5);
    scene.camera.lens_radius = random.chance(0.5) ? 0.0 : 0.1;
    scene.integrator.max_depth = 1 + random.integer(8);
    scene.lights = {random_light(random)};
    if (random.chance(0.3))
        scene.lights.push_back(random_light(random));
    return scene;
}

RenderOptions tiny(unsigned seed) {
    RenderOptions options;
    options.samples = 4;
    options.seed = seed;
    options.bands = grid_from_range(400, 700, 20);
    options.all_features = true;
    return options;
}

/// Renders a scene; returns nothing where the model refuses the material, with a reason.
std::optional<RenderResult> rendered(const Scene& scene, const RenderOptions& options) {
    try {
        return render(scene, device(), options);
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2) << error.what();
        return std::nullopt;
    }
}

TEST(RandomScenes, HoldNoNanNoInfinityAndNothingNegative) {
    const int count = test::is_full_run() ? 500 : 40;
    RandomMaterials random(17, test::is_full_run() ? 60 : 1);
    int done = 0;
    for (int i = 0; i < count; ++i) {
        const Scene scene = random_scene(random, random.material());
        RenderOptions options = tiny(static_cast<unsigned>(i));
        constexpr Model models[] = {Model::Auto, Model::Auto, Model::WeidlichWilkie};
        options.model = models[random.integer(3)];
        const auto result = rendered(scene, options);
        if (!result)
            continue;
        ++done;
        EXPECT_EQ(result->non_finite, 0U) << "scene " << i;
        for (const float value : result->image.values)
            ASSERT_TRUE(std::isfinite(value) && value >= 0.0f) << value << " in scene " << i;
    }
    EXPECT_GT(done, count / 2) << "too many were refused to say anything";
}

TEST(RandomScenes, ResidualThatEndsAtAnAngleTakesNoLightAway) {
    // scene 0 of a full run: the residual is 0 from some angle on, and interpolated beside
    // that kink it was negative
    Scene scene =
        sphere_scene(material({layer(1.43074, 0.298865, 3964.75), layer(1.0)}, 1.0), 6, 5);
    scene.lights = {RectangleLight{{0, 3, 1}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(1e4)}};
    RenderOptions options = tiny(0);
    options.samples = 64;
    const auto result = rendered(scene, options);
    ASSERT_TRUE(result);
    for (const float value : result->image.values)
        ASSERT_GE(value, 0.0f);
}

TEST(RandomScenes, WhiteFurnaceNeverShinesBrighterThanItsWalls) {
    // Radiance 1 from everywhere; what adding holds at one direction is at most 1 but for the
    // tables over angles (1e-3), Oren-Nayar's own excess (kernels/scatter/oren_nayar.h) and the
    // noise of sampling lobes, which the mean over 30 pixels of 64 samples has below 3 %.
    const int count = test::is_full_run() ? 300 : 12;
    RandomMaterials random(23, test::is_full_run() ? 60 : 1);
    for (int i = 0; i < count; ++i) {
        Material material = random.material();
        material.substrate.matrix.reset();
        if (material.substrate.type == SubstrateType::Conductor)
            material.substrate.type = SubstrateType::Lambert;
        Scene scene = sphere_scene(material, 6, 5);
        scene.lights = {environment(Spectrum::constant(1.0))};
        RenderOptions options = tiny(static_cast<unsigned>(i));
        options.samples = 64;
        const auto result = rendered(scene, options);
        if (!result)
            continue;
        const int bands = result->image.bands.count;
        for (int band = 0; band < bands; ++band)
            EXPECT_LE(band_statistics(result->image, band).mean, 1.03) << "scene " << i;
    }
}

} // namespace
} // namespace reradiant
