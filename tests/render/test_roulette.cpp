// Russian roulette ends paths that bring little, and must not cost more error than time.
#include "reradiant/spectral_image.h"
#include "tests/render/test_scenes.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

/// A saturated red: 0.04 in the blue, 0.77 in the red.
Spectrum red_paint() {
    return Spectrum::table({380, 560, 620, 780}, {0.04, 0.05, 0.74, 0.77});
}

/// Two parallel plates of one paint, as far apart as half their side, in even light.
Scene two_plates(const Material& paint) {
    Scene scene;
    scene.film.width = scene.film.height = 24;
    scene.camera.origin = {0, 0.6, 5};
    scene.camera.target = {0, 0, 0};
    scene.camera.fov_deg = 24;
    scene.materials = {paint};
    scene.shapes = {{RectangleShape{{0, -0.5, 0}, {2, 0, 0}, {0, 0, -2}}, 0},
                    {RectangleShape{{0, 0.5, 0}, {2, 0, 0}, {0, 0, 2}}, 0}};
    scene.lights = {environment(Spectrum::constant(1.0))};
    return scene;
}

SpectralImage rendered(Scene scene, bool roulette, int samples, std::uint32_t seed) {
    if (!roulette)
        scene.integrator.min_depth = scene.integrator.max_depth + 1;
    RenderOptions options;
    options.samples = samples;
    options.seed = seed;
    options.bands = grid_from_range(400, 700, 50);
    return render(scene, device(), options).image;
}

/// relMSE over that of the same samples without roulette, mean over seeds.
double price_of_roulette(const Scene& scene) {
    constexpr int samples = 32;
    const int seeds = test::is_full_run() ? 64 : 16;
    const SpectralImage reference = rendered(scene, false, 128 * samples, 1000);
    double with = 0.0, without = 0.0;
    for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(seeds); ++seed) {
        with += compare_images(rendered(scene, true, samples, seed), reference).relmse;
        without += compare_images(rendered(scene, false, samples, seed), reference).relmse;
    }
    return with / without;
}

// With the mean of the lanes in place of the largest the error was 2.5 times that without roulette.
TEST(Roulette, Case66SaturatedColourBetweenTwoSurfacesCostsLittleError) {
    Material paint = material({}, 0.5);
    paint.substrate.reflectance = red_paint();
    EXPECT_LT(price_of_roulette(two_plates(paint)), 1.1);
}

TEST(Roulette, Case66SaturatedColourUnderAVarnishLikewise) {
    Material paint = material({layer(1.5, 0.2)}, 0.5);
    paint.substrate.reflectance = red_paint();
    EXPECT_LT(price_of_roulette(two_plates(paint)), 1.1);
}

TEST(Roulette, Case66WalkLikewise) {
    Material paint = material({layer(1.5)}, 0.5);
    paint.model = Model::Walk;
    paint.substrate.reflectance = red_paint();
    EXPECT_LT(price_of_roulette(two_plates(paint)), 1.1);
}

// A grey of 0.5 between walls that send it on for ever: the depth alone would end no path.
TEST(Roulette, EndsLongPaths) {
    Scene scene = two_plates(material({}, 0.5));
    scene.integrator.max_depth = 64;
    RenderOptions options;
    options.samples = 16;
    options.bands = grid_from_range(500, 600, 50);
    const RenderResult with = render(scene, device(), options);
    scene.integrator.min_depth = 65;
    const RenderResult without = render(scene, device(), options);
    EXPECT_LT(with.rays, without.rays);
}

} // namespace
} // namespace reradiant
