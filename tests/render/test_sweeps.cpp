// Sweeps of what is compiled in or tabulated by size: bands and layers, in a white furnace.
#include "tests/render/test_scenes.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

/// Environment 1 over a white substrate beneath lossless layers: every band is 1 on the average
/// over the directions that are sampled, within 1e-3 for the tables' error over angles and 6
/// standard errors between pixels (family-wise 1e-6 for 300 bands).
void expect_white(const Material& look, const WavelengthGrid& bands, const std::string& where) {
    Scene scene = plane_scene(look, 40.0, 4, 3);
    scene.lights = {environment(Spectrum::constant(1.0))};
    RenderOptions options;
    options.samples = 1024;
    options.bands = bands;
    const RenderResult result = render(scene, device(), options);
    EXPECT_EQ(result.non_finite, 0U) << where;
    for (int band = 0; band < bands.count; ++band) {
        const BandStatistics found = band_statistics(result.image, band);
        ASSERT_NEAR(found.mean, 1.0, 1e-3 + 6.0 * found.standard_error)
            << where << ", band " << band;
        ASSERT_LT(found.standard_error, 1e-3) << where;
    }
}

TEST(Sweeps, BandsFromOneTo471) {
    const std::vector<int> counts = test::is_full_run()
                                        ? std::vector{1, 2, 15, 16, 17, 31, 64, 65, 128, 471}
                                        : std::vector{1, 17, 471};
    for (const int count : counts)
        expect_white(material({}, 1.0), WavelengthGrid{310, 1, count},
                     std::to_string(count) + " bands");
}

TEST(Sweeps, LayersFromOneTo64) {
    for (const int count : {1, 2, 7, 63, 64}) {
        std::vector<Layer> layers;
        for (int i = 0; i < count; ++i)
            layers.push_back(layer(i % 2 == 0 ? 1.5 : 1.3));
        expect_white(material(layers, 1.0), grid_from_range(400, 700, 20),
                     std::to_string(count) + " layers");
    }
}

TEST(Sweeps, IndexOfRefractionAcrossOneAndUpToFour) {
    for (const double ior : {1.0, 1.0 + 1e-6, 1.0 + 1e-4, 1.01, 1.5, 2.4, 4.0})
        expect_white(material({layer(ior)}, 1.0), grid_from_range(400, 700, 20),
                     "IOR " + std::to_string(ior));
}

TEST(Sweeps, OpticalDepthFromNothingToBlack) {
    double before = 2.0;
    for (const double tau : {0.0, 1e-8, 1e-6, 1e-3, 1.0, 104.0, 1e4}) {
        Scene scene = plane_scene(material({layer(1.5, 0.0, tau)}, 1.0), 40.0, 4, 3);
        scene.lights = {environment(Spectrum::constant(1.0))};
        RenderOptions options;
        options.samples = 16;
        options.bands = grid_from_range(400, 700, 100);
        const RenderResult result = render(scene, device(), options);
        const double mean = band_statistics(result.image, 0).mean;
        EXPECT_LE(mean, before + 1e-6) << tau;
        EXPECT_GT(mean, 0.03) << "what the surface reflects is left";
        EXPECT_EQ(result.non_finite, 0U);
        before = mean;
    }
}

} // namespace
} // namespace reradiant
