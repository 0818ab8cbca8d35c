#include "host/layers/models/effective_matrix.h"
#include "host/layers/models/weidlich_wilkie.h"
#include "reradiant/stack_model.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

using namespace test;
using std::numbers::pi;

double cosine(double degrees) {
    return std::cos(degrees * pi / 180.0);
}

/// f(o, i) summed over excitation for a flat irradiance, times cos(theta_i): radiance of a
/// diffuse substrate under a stack lit by unit irradiance from one direction.
double adding_radiance(const Material& m, const Eigen::MatrixXd& matrix, int band, double view,
                       double incidence) {
    const auto t = adding_transport(stack_at(m.stack, 550.0));
    const Eigen::MatrixXd effective = effective_matrix(
        matrix, Eigen::VectorXd::Constant(matrix.rows(), t->internal_reflectance()));
    return t->transmission(cosine(view)) * t->transmission(cosine(incidence)) *
           effective.row(band).sum() / (pi * t->lowest_ior() * t->lowest_ior()) * cosine(incidence);
}

RenderResult render_plane(const Material& m, double view, double incidence,
                          const WavelengthGrid& bands, Model model = Model::Auto) {
    Scene scene = plane_scene(m, view, 8, 8);
    scene.lights = {directional(incidence, 90.0, Spectrum::constant(1.0))};
    scene.integrator.max_depth = 1;
    RenderOptions options;
    options.bands = bands;
    options.samples = 4;
    options.model = model;
    options.wavelengths.centred = true;
    return render(scene, device(), options);
}

TEST(LightTransport, DirectionalLightOnSmoothStackHasTheClosedFormRadiance) {
    const ReradiationMatrix matrix = shifted_matrix();
    for (const auto& layers : {std::vector<Layer>{}, {layer(1.5)}, {layer(1.3), layer(1.6)}})
        for (const double view : {5.0, 45.0, 80.0}) {
            const Material m = fluorescent(layers, matrix);
            const RenderResult result = render_plane(m, view, 30.0, matrix.emission);
            for (int band = 0; band < matrix.emission.count; ++band) {
                const double expected = adding_radiance(m, matrix.values, band, view, 30.0);
                // Single precision along the path, and 0.005 degrees of view over the film.
                EXPECT_NEAR(band_statistics(result.image, band).mean, expected, 2e-5 * expected)
                    << layers.size() << " layers, view " << view << ", band " << band;
            }
        }
}

TEST(LightTransport, AbsorbingSlabTakesEachWavelengthByItsOwn) {
    Layer slab = layer(1.5);
    slab.absorption = Spectrum::table({400, 700}, {0.1, 3.0});
    const Material m = material({slab}, 0.7);
    const WavelengthGrid bands = grid_from_range(400, 700, 20);
    const RenderResult result = render_plane(m, 50.0, 20.0, bands);
    for (int band = 0; band < bands.count; ++band) {
        const auto t = adding_transport(stack_at(m.stack, bands.centre_nm(band)));
        const double rho = 0.7;
        const double expected = t->transmission(cosine(50)) * t->transmission(cosine(20)) * rho /
                                (1.0 - rho * t->internal_reflectance()) / (pi * 2.25) * cosine(20);
        EXPECT_NEAR(band_statistics(result.image, band).mean, expected, 2e-5 * expected) << band;
    }
}

TEST(LightTransport, RoughTopHasItsLobeAndItsDiffusePart) {
    const Material m = material({layer(1.5, 0.3)}, 0.5);
    const auto t = adding_transport(stack_at(m.stack, 550.0));
    EXPECT_TRUE(t->has_top_lobe());
    const WavelengthGrid bands = grid_from_range(500, 540, 20);
    const RenderResult result = render_plane(m, 40.0, 30.0, bands);
    const double diffuse = adding_radiance(m, Eigen::MatrixXd::Constant(1, 1, 0.5), 0, 40.0, 30.0);
    EXPECT_GT(band_statistics(result.image, 0).mean, diffuse);
}

TEST(LightTransport, WeidlichWilkieMatchesItsDoubleTwin) {
    for (const double alpha : {0.0, 0.2}) {
        Layer top = layer(1.5, alpha, 0.2);
        top.distribution = Distribution::Blinn;
        top.scattering = Scattering::Single; // the residual of `multiple` is in test_materials.cpp
        const Material m = material({top}, 0.6);
        const WavelengthGrid bands = grid_from_range(500, 540, 20);
        const RenderResult result = render_plane(m, 40.0, 30.0, bands, Model::WeidlichWilkie);
        const auto direction = [](double theta, double phi) {
            const double s = std::sin(theta * pi / 180.0);
            return kernels::vec3(s * std::cos(phi * pi / 180.0), s * std::sin(phi * pi / 180.0),
                                 cosine(theta));
        };
        const StackElements stack = stack_at(m.stack, 520.0);
        const kernels::Vec3 wi = direction(30, 90), wo = direction(40, 0);
        const double f = WeidlichWilkie::specular(stack, wi, wo) +
                         WeidlichWilkie::way_in(stack, wi, wo) * 0.6 *
                             WeidlichWilkie::way_out(stack, wi, wo) / pi;
        EXPECT_NEAR(band_statistics(result.image, 1).mean, f * cosine(30), 5e-5 * f) << alpha;
    }
}

TEST(LightTransport, DispersiveWeidlichWilkieGoesInAndOutAtItsOwnWavelengths) {
    Layer top = layer(1.5, 0.2, 0.2), below = layer(1.7, 0.3);
    top.ior = Spectrum::table({400, 700}, {1.7, 1.4});
    top.scattering = below.scattering = Scattering::Single;
    const ReradiationMatrix matrix = shifted_matrix();
    const Material m = fluorescent({top, below}, matrix);
    const RenderResult result = render_plane(m, 40.0, 30.0, matrix.emission, Model::WeidlichWilkie);
    const double s30 = std::sin(pi / 6), s40 = std::sin(40 * pi / 180);
    const kernels::Vec3 wi = kernels::vec3(0, s30, cosine(30)),
                        wo = kernels::vec3(s40, 0, cosine(40));
    for (int o = 0; o < matrix.emission.count; ++o) {
        const StackElements out = stack_at(m.stack, matrix.emission.centre_nm(o));
        double f = WeidlichWilkie::specular(out, wi, wo);
        for (int i = 0; i < matrix.excitation.count; ++i)
            f += WeidlichWilkie::way_out(out, wi, wo) * matrix.values(o, i) / pi *
                 WeidlichWilkie::way_in(stack_at(m.stack, matrix.excitation.centre_nm(i)), wi, wo);
        EXPECT_NEAR(band_statistics(result.image, o).mean, f * cosine(30), 5e-5 * f) << o;
    }
}

/// Mean radiance of a white Lambertian plane: irradiance over pi.
double irradiance_of(const Light& light, std::uint32_t samples, double& standard_error) {
    // From the side, so that the light does not stand before the camera.
    Scene scene = plane_scene(material({}, 1.0), 60.0, 16, 16);
    scene.lights = {light};
    scene.integrator.max_depth = 1;
    RenderOptions options;
    options.bands = grid_from_range(500, 520, 20);
    options.samples = samples;
    const RenderResult result = render(scene, device(), options);
    const BandStatistics found = band_statistics(result.image, 0);
    standard_error = found.standard_error * pi;
    return found.mean * pi;
}

TEST(LightTransport, RectangleLightGivesItsFormFactor) {
    // Square of side 2, parallel, at height 2, centred: E = 4 times the corner form factor.
    const Light light = RectangleLight{{0, 2, 0}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(1.0)};
    const double x = 0.5;
    const double corner =
        2.0 * x / std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x)) / (2.0 * pi);
    double error = 0.0;
    const double found = irradiance_of(light, 256, error);
    EXPECT_NEAR(found, 4.0 * corner * pi, test::sidak_bound(3) * error + 1e-4);
}

TEST(LightTransport, SphereLightGivesTheSineSquared) {
    double error = 0.0;
    const double found =
        irradiance_of(SphereLight{{0, 3, 0}, 1.0, Spectrum::constant(1.0)}, 256, error);
    EXPECT_NEAR(found, pi / 9.0, test::sidak_bound(3) * error + 1e-4);
}

TEST(LightTransport, PointLightFallsWithTheSquare) {
    double error = 0.0;
    const double found = irradiance_of(PointLight{{0, 2, 0}, Spectrum::constant(1.0)}, 16, error);
    EXPECT_NEAR(found, 0.25, test::sidak_bound(3) * error + 1e-4);
}

TEST(LightTransport, MirrorReflectionOfALightHasItsRadianceTimesFresnel) {
    // Seen in a smooth black layer: Fresnel reflectance of the mirror direction alone.
    const Material m = material({layer(1.5)}, 0.0);
    Scene scene = plane_scene(m, 0.01, 4, 4);
    scene.camera.up = {0, 0, 1};
    scene.lights = {RectangleLight{{0, 20, 0}, {10, 0, 0}, {0, 0, 10}, Spectrum::constant(3.0)}};
    RenderOptions options;
    options.bands = grid_from_range(500, 520, 20);
    options.samples = 256;
    const RenderResult result = render(scene, device(), options);
    const BandStatistics found = band_statistics(result.image, 0);
    EXPECT_NEAR(found.mean, 3.0 * 0.04, test::sidak_bound(1) * found.standard_error + 1e-5);
}

} // namespace
} // namespace reradiant
