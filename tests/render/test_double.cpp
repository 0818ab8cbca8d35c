// Kernels in double precision against those in single: the same samples, so that what differs is
// what single precision costs.
#include "tests/render/test_scenes.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace reradiant {
namespace {

using namespace test;

RenderResult rendered(const Material& look, Model model, bool in_double) {
    Scene scene = sphere_scene(look, 24, 24);
    scene.lights = {environment(Spectrum::constant(0.3)),
                    RectangleLight{{0, 4, 1}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(5.0)}};
    RenderOptions options;
    options.samples = 16;
    options.bands = grid_from_range(400, 700, 20);
    options.model = model;
    options.in_double = in_double;
    return render(scene, device(), options);
}

/// Mean distance of two images over the mean of the first.
double mean_distance(const SpectralImage& a, const SpectralImage& b) {
    double distance = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        distance += std::fabs(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i]));
        sum += static_cast<double>(a.values[i]);
    }
    return distance / sum;
}

TEST(InDouble, ImagesDifferByRoundingAlone) {
    if (!device().info().has_double)
        GTEST_SKIP() << "the device has no double precision";
    const Material coated = fluorescent({layer(1.5, 0.2, 0.3)}, shifted_matrix());
    std::vector<Model> models = {Model::Adding}; // two sets of programs each
    if (test::is_full_run())
        models.insert(models.end(), {Model::WeidlichWilkie, Model::Walk});
    for (const Model model : models) {
        const RenderResult single = rendered(coated, model, false);
        const RenderResult with_double = rendered(coated, model, true);
        EXPECT_FALSE(single.features.at("double"));
        EXPECT_TRUE(with_double.features.at("double"));
        EXPECT_EQ(with_double.non_finite, 0U);
        const double distance = mean_distance(with_double.image, single.image);
        EXPECT_GT(distance, 0.0) << "the same kernels ran";
        // Roundings are near 1e-6; a rounded comparison that sends one path of 9216 elsewhere
        // moves the mean by up to 1e-4.
        EXPECT_LT(distance, 1e-3) << "model " << static_cast<int>(model);
    }
}

} // namespace
} // namespace reradiant
