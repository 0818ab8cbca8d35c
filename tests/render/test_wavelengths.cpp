#include "reradiant/measure.h"
#include "reradiant/reradiation.h"
#include "reradiant/wavelength_plan.h"
#include "tests/render/test_scenes.h"

#include <Eigen/Core>
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

/// Returns a matrix that sends light from one band into another, both 10 nm wide.
ReradiationMatrix step_matrix(double from_nm, double to_nm) {
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = grid_from_range(380, 980, 10);
    matrix.values = 0.1 * Eigen::MatrixXd::Identity(61, 61);
    matrix.values(matrix.emission.band_of(to_nm), matrix.excitation.band_of(from_nm)) = 0.5;
    matrix.anti_stokes_allowed = true;
    return matrix;
}

TEST(WavelengthPlan, LightThatOneMaterialMakesExcitesAnother) {
    // A lamp at 400 nm, one material from 400 to 500 nm, the other from 500 to 600 nm: whichever
    // comes first in the scene, 600 nm is seen.
    const Material first = fluorescent({}, step_matrix(400, 500)),
                   second = fluorescent({}, step_matrix(500, 600));
    for (const bool reversed : {false, true}) {
        Scene scene = lit_by(Spectrum::line(400.0, 5.0, 1.0), reversed ? second : first);
        scene.materials.push_back(reversed ? first : second);
        const WavelengthPlan plan = plan_wavelengths(scene, grid_from_range(380, 780, 10), {});
        EXPECT_DOUBLE_EQ(plan.comb.to_nm(), 600.0);
    }
}

TEST(WavelengthPlan, AntiStokesStepsInARowReachTheFilm) {
    // A lamp at 900 nm, far above the film, excites 800 nm and that 700 nm.
    ReradiationMatrix matrix = step_matrix(900, 800);
    matrix.values(matrix.emission.band_of(700), matrix.excitation.band_of(800)) = 0.5;
    const Scene scene = lit_by(Spectrum::line(900.0, 5.0, 1.0), fluorescent({}, matrix));
    const WavelengthPlan plan = plan_wavelengths(scene, grid_from_range(380, 780, 10), {});
    EXPECT_LE(plan.comb.from_nm, 700.0);
    EXPECT_GE(plan.comb.to_nm(), 900.0);
    // This matrix emits only above its excitation, so that nothing above the film can be seen.
    const Scene stokes = lit_by(Spectrum::constant(1.0), fluorescent({}, step_matrix(400, 900)));
    EXPECT_DOUBLE_EQ(plan_wavelengths(stokes, grid_from_range(380, 780, 10), {}).comb.to_nm(),
                     780.0);
}

TEST(WavelengthPlan, AntiStokesLightOfTwoStepsIsRendered) {
    // The matrix lies under a coat of n = 1.5 as a Lambertian substrate; all models and samplers of
    // wavelengths that render it are compared with the goniophotometer.
    ReradiationMatrix matrix = step_matrix(900, 800);
    matrix.values(matrix.emission.band_of(700), matrix.excitation.band_of(800)) = 0.5;
    Material coated = fluorescent({}, matrix);
    coated.stack.layers.push_back({});
    MeasureRequest request;
    request.hemispherical = true;
    request.theta_i_deg = {20}; // as the camera sees it: directions may be swapped
    request.model = Model::Adding;
    double expected = 0.0; // share of the irradiance at 900 nm that leaves at 700 nm
    for (const MeasureRow& row : measure_material(coated, request).rows)
        if (row.lambda_i_nm == 900.0 && row.lambda_o_nm == 700.0)
            expected = row.value;
    ASSERT_GT(expected, 1e-3);
    for (const Model model : {Model::Adding, Model::Walk})
        for (const int hero : {0, 4}) {
            if (hero > 0 && model == Model::Walk)
                continue; // which the program refuses
            Scene scene = lit_by(Spectrum::line(900.0, 10.0, 10.0), coated);
            RenderOptions options;
            options.model = model;
            options.bands = grid_from_range(380, 780, 10);
            options.wavelengths.hero_count = hero;
            options.samples = 2048;
            const RenderResult result = render(scene, device(), options);
            const int band = result.image.bands.band_of(700.0);
            const BandStatistics found = band_statistics(result.image, band);
            // Radiance 1 per nm over the band of 900 nm, from everywhere.
            EXPECT_NEAR(found.mean, expected, 0.01 * expected + 6.0 * found.standard_error)
                << model_name(model) << ", hero " << hero;
        }
}

TEST(WavelengthPlan, Case32NarrowLineStandsBesideTheCombAndKeepsItsPower) {
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
