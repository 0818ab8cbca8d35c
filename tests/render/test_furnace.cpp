#include "host/layers/models/effective_matrix.h"
#include "reradiant/stack_model.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace reradiant {
namespace {

using namespace test;

RenderResult render_in_white_furnace(const Material& m, std::uint32_t samples,
                                     RenderOptions options = {}) {
    Scene scene = sphere_scene(m, 24, 24);
    scene.lights = {environment(Spectrum::constant(1.0))};
    options.samples = samples;
    return render(scene, device(), options);
}

/// Every band of every furnace: 1 within 0.1 % plus Sidak's share of standard errors.
void expect_white(const Material& m, const char* what) {
    const RenderResult result = render_in_white_furnace(m, 256);
    EXPECT_EQ(result.non_finite, 0u) << what;
    for (int band = 0; band < result.image.bands.count; ++band) {
        const BandStatistics found = band_statistics(result.image, band);
        EXPECT_NEAR(found.mean, 1.0, 1e-3 + test::sidak_bound(41 * 8) * found.standard_error)
            << what << ", band " << band;
    }
}

TEST(Furnace, Case33BareWhiteSubstrateIsWhite) {
    expect_white(material({}, 1.0), "bare");
}

TEST(Furnace, WhiteUnderSmoothLayerIsWhite) {
    expect_white(material({layer(1.5)}, 1.0), "n 1.5");
    expect_white(material({layer(2.4)}, 1.0), "n 2.4");
}

TEST(Furnace, WhiteUnderTwoSmoothLayersIsWhite) {
    expect_white(material({layer(1.3), layer(1.6)}, 1.0), "1.3 over 1.6");
}

TEST(Furnace, WhiteUnderRoughLayerIsWhite) {
    expect_white(material({layer(1.5, 0.1)}, 1.0), "n 1.5, alpha 0.1");
    expect_white(material({layer(1.5, 0.4)}, 1.0), "n 1.5, alpha 0.4");
}

TEST(Furnace, WhiteUnderRoughAndSmoothLayersIsWhite) {
    expect_white(material({layer(1.3), layer(1.6, 0.3)}, 1.0), "smooth over rough");
    expect_white(material({layer(1.3, 0.3), layer(1.6, 0.2)}, 1.0), "rough over rough");
}

TEST(Furnace, WhiteScatteringSlabOverWhiteIsWhite) {
    Layer slab = layer(1.4);
    slab.scattering_coefficient = Spectrum::constant(2.0);
    slab.anisotropy = 0.6;
    expect_white(material({slab}, 1.0), "scattering slab");
    slab.alpha = 0.3;
    expect_white(material({layer(1.6), slab}, 1.0), "smooth over rough over scattering");
}

/// Radiance of a re-radiating plane in a furnace of radiance 1: reciprocity turns the integral
/// over the incident directions into 2 int c T dc = n^2 (1 - r).
double analytic_furnace(const Material& m, const Eigen::MatrixXd& matrix, int band, double c) {
    const auto transport = adding_transport(stack_at(m.stack, 550.0));
    const double r = transport->internal_reflectance();
    const Eigen::MatrixXd effective =
        effective_matrix(matrix, Eigen::VectorXd::Constant(matrix.rows(), r));
    return transport->specular_albedo(c) +
           transport->transmission(c) * effective.row(band).sum() * (1.0 - r);
}

void expect_matrix_furnace(std::vector<Layer> layers, double view_deg, const char* what) {
    const ReradiationMatrix matrix = shifted_matrix();
    const Material m = fluorescent(std::move(layers), matrix);
    Scene scene = plane_scene(m, view_deg, 16, 16);
    scene.lights = {environment(Spectrum::constant(1.0))};
    RenderOptions options;
    options.bands = matrix.emission;
    options.samples = 256;
    const RenderResult result = render(scene, device(), options);
    for (int band = 0; band < matrix.emission.count; ++band) {
        const BandStatistics found = band_statistics(result.image, band);
        const double expected =
            analytic_furnace(m, matrix.values, band, std::cos(view_deg * 3.14159265358979 / 180.0));
        EXPECT_NEAR(found.mean, expected,
                    1e-3 * expected + test::sidak_bound(16 * 3) * found.standard_error)
            << what << ", band " << band;
    }
}

TEST(Furnace, KnownMatrixGivesItsRowSums) {
    expect_matrix_furnace({}, 30.0, "bare");
    expect_matrix_furnace({layer(1.5)}, 60.0, "smooth");
    expect_matrix_furnace({layer(1.5, 0.3)}, 20.0, "rough");
}

TEST(Furnace, DenseAndFactoredMatrixAgree) {
    // An entry far from the rest raises the rank beyond what is factored.
    ReradiationMatrix dense = shifted_matrix();
    for (int i = 0; i < 8; ++i)
        dense.values(i + 7, i) += 0.02 + 0.003 * i;
    const Material m = fluorescent({layer(1.5)}, dense);
    Scene scene = plane_scene(m, 40.0, 8, 8);
    scene.lights = {environment(Spectrum::constant(1.0))};
    RenderOptions options;
    options.bands = dense.emission;
    options.samples = 64;
    const RenderResult result = render(scene, device(), options);
    EXPECT_TRUE(result.features.at("dense_matrix"));
    for (int band = 0; band < dense.emission.count; ++band) {
        const BandStatistics found = band_statistics(result.image, band);
        const double expected =
            analytic_furnace(m, dense.values, band, std::cos(40.0 * 3.14159265358979 / 180.0));
        EXPECT_NEAR(found.mean, expected,
                    1e-3 * expected + test::sidak_bound(16) * found.standard_error)
            << "band " << band;
    }
}

TEST(Furnace, Case30UltravioletAloneMakesVisibleLight) {
    ReradiationMatrix matrix = shifted_matrix();
    matrix.emission = matrix.excitation = grid_from_range(320, 620, 20);
    Scene scene = sphere_scene(fluorescent({layer(1.5)}, matrix), 16, 16);
    scene.lights = {environment(Spectrum::line(365.0, 5.0, 1.0))};
    RenderOptions options;
    options.samples = 64;
    options.bands = grid_from_range(380, 780, 10);
    const RenderResult result = render(scene, device(), options);
    double visible = 0.0;
    for (int band = 5; band < result.image.bands.count; ++band)
        visible += band_statistics(result.image, band).mean;
    EXPECT_GT(visible, 1e-3);
}

} // namespace
} // namespace reradiant
