#include "host/render/wavelength_plan.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace reradiant {
namespace {

using namespace test;

Scene lit_by(const Spectrum& spectrum, const Material& m) {
    Scene scene = plane_scene(m, 20.0, 4, 4);
    scene.lights = {environment(spectrum)};
    return scene;
}

TEST(WavelengthPlan, DefaultRangeReachesTheUltravioletOnlyWhenSomethingFluoresces) {
    EXPECT_EQ(film_bands(lit_by(Spectrum::constant(1), material({}, 0.5))).from_nm, 380.0);
    EXPECT_EQ(film_bands(lit_by(Spectrum::constant(1), fluorescent({}, shifted_matrix()))).from_nm,
              300.0);
}

TEST(WavelengthPlan, CombReachesBelowTheFilmAsFarAsSomethingExcites) {
    const Scene scene = lit_by(Spectrum::constant(1), fluorescent({}, shifted_matrix()));
    const WavelengthPlan plan = plan_wavelengths(scene, grid_from_range(500, 700, 10), {});
    EXPECT_LE(plan.comb.lower_edge_nm(0), 395.0);
    EXPECT_EQ(plan.film.count, 21);
}

TEST(WavelengthPlan, BandsThatNoLightReachesAreLeftOutAndNamed) {
    const Scene scene = lit_by(Spectrum::line(500.0, 5.0, 1.0), fluorescent({}, shifted_matrix()));
    const WavelengthPlan plan = plan_wavelengths(scene, grid_from_range(380, 780, 10), {});
    EXPECT_GT(plan.comb.from_nm, 480.0);
    EXPECT_FALSE(plan.left_out.empty());
}

TEST(WavelengthPlan, NarrowLineStandsBesideTheCombAndKeepsItsPower) {
    for (const double width : {0.5, 5.0, 10.0, 15.0, 40.0})
        for (const double centre : {403.2, 405.0, 410.0}) {
            Scene scene = lit_by(Spectrum::line(centre, width, 2.0), material({}, 1.0));
            RenderOptions options;
            options.bands = grid_from_range(380, 480, 10);
            options.samples = 32;
            const RenderResult result = render(scene, device(), options);
            double power = 0.0;
            for (int band = 0; band < result.image.bands.count; ++band)
                power += 10.0 * band_statistics(result.image, band).mean;
            EXPECT_NEAR(power, 2.0, 2e-5) << width << " nm wide at " << centre;
        }
}

TEST(WavelengthPlan, AnyCombCountGivesTheSameBandMeans) {
    const Spectrum sloped = Spectrum::table({380, 780}, {0.2, 1.0});
    for (const int count : {7, 41, 64, 100}) {
        Scene scene = lit_by(sloped, material({}, 1.0));
        RenderOptions options;
        options.bands = grid_from_range(380, 780, 10);
        options.wavelengths.comb_count = count;
        options.samples = 512;
        const RenderResult result = render(scene, device(), options);
        for (int band = 0; band < 41; ++band) {
            const double expected = sloped.average(375.0 + 10.0 * band, 385.0 + 10.0 * band);
            const BandStatistics found = band_statistics(result.image, band);
            // A sub-cell cut by a band's edge is taken as constant: 1.25 nm of the slope.
            EXPECT_NEAR(found.mean, expected, 3e-3 * expected + 6.0 * found.standard_error)
                << count << " wavelengths, band " << band;
        }
    }
}

TEST(WavelengthPlan, AllSamplesAreTakenWhereTheHalvesAreEqual) {
    // Nothing but a sky is seen, so that the estimated error is 0 from the second sample on; its
    // spectrum takes 128 samples, two for each of the 64 phases of a cell of 50 nm.
    const Spectrum sloped = Spectrum::table({400, 700}, {0.2, 1.0});
    Scene scene = lit_by(sloped, material({}, 1.0));
    scene.shapes.clear();
    RenderOptions options;
    options.bands = grid_from_range(425, 675, 50);
    options.samples = 128;
    const RenderResult result = render(scene, device(), options);
    EXPECT_EQ(result.samples, 128u);
    for (int band = 0; band < 6; ++band)
        EXPECT_NEAR(band_statistics(result.image, band).mean,
                    sloped.average(400.0 + 50.0 * band, 450.0 + 50.0 * band), 1e-6);
}

} // namespace
} // namespace reradiant
