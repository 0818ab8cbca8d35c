#include "host/layers/stack/directions.h"
#include "host/layers/stack/lobe_quadrature.h"
#include "host/measure/measure_substrate.h"
#include "kernels/scatter/microfacet.h"
#include "kernels/scatter/oren_nayar.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"
#include "tests/layers/layer_values.h"
#include "tests/support/private_cache.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

using namespace reradiant;
using kernels::Vec3;

namespace {

const test::PrivateCache cache("measure-materials");
const WavelengthGrid one{550, 10, 1};

double cos_deg(double degrees) {
    return std::cos(degrees * M_PI / 180.0);
}
double fresnel(double c, std::complex<double> n) {
    const std::complex<double> q = std::sqrt(n * n - (1.0 - c * c));
    const std::complex<double> s = (c - q) / (c + q), p = (n * n * c - q) / (n * n * c + q);
    return 0.5 * (std::norm(s) + std::norm(p));
}

Layer layer(double ior, double alpha = 0.0, Scattering scattering = Scattering::Multiple) {
    Layer made;
    made.ior = Spectrum::constant(ior);
    made.alpha = alpha;
    made.scattering = scattering;
    return made;
}
SubstrateValues oren_nayar(double reflectance, double sigma) {
    return {Eigen::MatrixXd::Constant(1, 1, reflectance), sigma, {}};
}
SubstrateValues conductor(double ior, double kappa, double alpha,
                          Distribution d = Distribution::Ggx, Scattering s = Scattering::Multiple) {
    return {{}, 0.0, {conductor_values(ior, kappa, d, alpha, s)}};
}

MeasureRequest hemispherical(Model model, std::vector<double> thetas) {
    MeasureRequest request;
    request.model = model;
    request.theta_i_deg = std::move(thetas);
    request.hemispherical = true;
    return request;
}

/// Light of the substrate and all other.
struct Parts {
    double diffuse = 0.0, specular = 0.0;
};
Parts whole(const LayerStack& stack, const SubstrateValues& substrate, Model model, double theta) {
    Parts sum;
    for (const MeasureRow& row :
         measure_substrate(stack, substrate, one, hemispherical(model, {theta})).rows)
        (row.part == MeasuredPart::Diffuse ? sum.diffuse : sum.specular) += row.value;
    return sum;
}

/// Directional rows summed over the hemisphere: midpoint rule of 90 x 90 over one half.
Parts integral(const LayerStack& stack, const SubstrateValues& substrate, Model model,
               double theta) {
    MeasureRequest request;
    request.model = model;
    request.theta_i_deg = {theta};
    request.theta_o_deg.clear();
    request.phi_deg.clear();
    const int steps = 90;
    for (int i = 0; i < steps; ++i) {
        request.theta_o_deg.push_back((i + 0.5) * 90.0 / steps);
        request.phi_deg.push_back((i + 0.5) * 180.0 / steps);
    }
    Parts sum;
    for (const MeasureRow& row : measure_substrate(stack, substrate, one, request).rows) {
        const double t = row.theta_o_deg * M_PI / 180;
        const double weight =
            std::sin(t) * std::cos(t) * (0.5 * M_PI / steps) * (2 * M_PI / steps) * row.value;
        (row.part == MeasuredPart::Diffuse ? sum.diffuse : sum.specular) += weight;
    }
    return sum;
}

} // namespace

TEST(MeasureMaterials, BareOrenNayarIsItsOwnFormulaInBothModels) {
    MeasureRequest request;
    request.theta_i_deg = {50};
    request.theta_o_deg = {20, 70};
    request.phi_deg = {0, 60, 180};
    for (const Model model : {Model::Adding, Model::WeidlichWilkie}) {
        request.model = model;
        for (const MeasureRow& row :
             measure_substrate({}, oren_nayar(0.8, 0.4), one, request).rows) {
            const Vec3 wi = direction_at(cos_deg(50), 0.0);
            const Vec3 wo = direction_at(cos_deg(row.theta_o_deg), row.phi_deg * M_PI / 180);
            const double expected = row.part == MeasuredPart::Diffuse
                                        ? 0.8 * kernels::oren_nayar_value(0.4, wi, wo)
                                        : 0.0;
            EXPECT_NEAR(row.value, expected, 1e-14);
        }
        EXPECT_NEAR(whole({}, oren_nayar(0.8, 0.4), model, 50).diffuse,
                    0.8 * kernels::oren_nayar_albedo(0.4, cos_deg(50)), 1e-6);
    }
}

TEST(MeasureMaterials, OrenNayarOfNoRoughnessIsLambertianUnderALayer) {
    const LayerStack stack{{layer(1.5)}};
    for (const Model model : {Model::Adding, Model::WeidlichWilkie}) {
        MeasureRequest request;
        request.model = model;
        request.theta_o_deg = {30};
        const auto value = [&](double sigma) {
            return measure_substrate(stack, oren_nayar(0.8, sigma), one, request).rows[0].value;
        };
        EXPECT_NEAR(value(1e-9) / value(0.0), 1.0, 1e-8);
    }
}

TEST(MeasureMaterials, HemisphericalIsTheIntegralOfTheDirectional) {
    Layer milky = layer(1.5, 0.3);
    milky.absorption = Spectrum::constant(0.1);
    milky.scattering_coefficient = Spectrum::constant(0.4);
    milky.anisotropy = 0.5;
    Layer flaked = layer(1.4);
    flaked.flakes = Flakes{0.3, {}};
    flaked.flakes->reflector.ior = Spectrum::constant(0.4);
    flaked.flakes->reflector.kappa = Spectrum::constant(2.4);
    flaked.flakes->reflector.alpha = 0.3;
    struct Case {
        LayerStack stack;
        SubstrateValues substrate;
        Model model;
    };
    const std::vector<Case> cases{
        {{{layer(1.5, 0.3)}}, oren_nayar(0.8, 0.5), Model::Adding},
        {{{milky}}, oren_nayar(0.8, 0.0), Model::Adding},
        {{{layer(1.5, 0.3)}}, oren_nayar(0.8, 0.5), Model::WeidlichWilkie},
        {{{milky}}, oren_nayar(0.8, 0.3), Model::WeidlichWilkie},
        {{{flaked}}, oren_nayar(0.5, 0.0), Model::WeidlichWilkie},
        {{{layer(1.5)}}, conductor(0.4, 2.4, 0.3), Model::WeidlichWilkie},
        {{{milky}}, conductor(0.4, 2.4, 0.4, Distribution::Blinn), Model::WeidlichWilkie},
    };
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const auto& [stack, substrate, model] = cases[k];
        for (const double theta : {0.0, 50.0}) {
            const Parts expected = integral(stack, substrate, model, theta);
            const Parts found = whole(stack, substrate, model, theta);
            const double mirror = stack.is_smooth()
                                      ? fresnel(cos_deg(theta), cases[k].stack.layers[0].ior(550))
                                      : 0.0;
            // the midpoint rule is good to 1e-3
            EXPECT_NEAR(found.diffuse, expected.diffuse, 1e-3) << k << " " << theta;
            EXPECT_NEAR(found.specular - mirror, expected.specular, 1e-3) << k << " " << theta;
        }
    }
}

TEST(MeasureMaterials, Case17SmoothConductorIsPartOfTheDiffuseRows) {
    const LayerStack stack{{layer(1.5)}};
    for (const double theta : {0.0, 60.0}) {
        const double c = cos_deg(theta), inner = std::sqrt(2.25 - 1 + c * c) / 1.5;
        const Parts found = whole(stack, conductor(0.4, 2.4, 0.0), Model::WeidlichWilkie, theta);
        const double r = fresnel(c, 1.5);
        EXPECT_NEAR(found.specular, r, 1e-12);
        EXPECT_NEAR(found.diffuse,
                    (1 - r) * (1 - r) * fresnel(inner, std::complex<double>(0.4, 2.4) / 1.5),
                    1e-12);
    }
    MeasureRequest request;
    request.model = Model::WeidlichWilkie;
    const Measurement directional =
        measure_substrate(stack, conductor(0.4, 2.4, 0.0), one, request);
    EXPECT_EQ(directional.rows[0].value, 0.0);
    EXPECT_EQ(directional.rows[1].value, 0.0);
    ASSERT_FALSE(directional.notes.empty());
    EXPECT_NE(directional.notes[0].find("is a delta"), std::string::npos);
}

TEST(MeasureMaterials, Case17PerfectConductorsReflectEverything) {
    // an index of nearly 0 reflects all: 1e-9 is what it keeps
    EXPECT_NEAR(whole({}, conductor(1e-9, 5.0, 0.0), Model::WeidlichWilkie, 40).diffuse, 1.0, 1e-8);
    for (const double alpha : {0.02, 0.3, 0.8}) {
        for (const double theta : {0.0, 45.0, 80.0}) {
            const double albedo =
                whole({}, conductor(1e-9, 5.0, alpha), Model::WeidlichWilkie, theta).diffuse;
            EXPECT_NEAR(albedo, 1.0, 1e-3) << alpha << " " << theta; // the error of lobe_albedo
        }
    }
    const double single =
        whole({}, conductor(1e-9, 5.0, 0.8, Distribution::Ggx, Scattering::Single),
              Model::WeidlichWilkie, 0)
            .diffuse;
    EXPECT_LT(single, 0.9);
}

TEST(MeasureMaterials, WhiteScatteringSlabOverWhiteReflectsEverything) {
    Layer milky = layer(1.5, 0.2);
    milky.scattering_coefficient = Spectrum::constant(2.0);
    milky.anisotropy = 0.3;
    for (const double theta : {0.0, 60.0}) {
        const Parts found = whole({{milky}}, oren_nayar(1.0, 0.0), Model::Adding, theta);
        EXPECT_NEAR(found.diffuse + found.specular, 1.0, 1e-6) << theta;
    }
}

TEST(MeasureMaterials, AddingRefusesConductors) {
    EXPECT_THROW(
        measure_substrate({}, conductor(0.4, 2.4, 0.1), one, hemispherical(Model::Adding, {0})),
        Error);
}

TEST(MeasureMaterials, NumbersOutOfRangeAreRefusedByEveryModel) {
    const auto refused = [](const LayerStack& stack, const SubstrateValues& substrate) {
        for (const Model model : {Model::WeidlichWilkie, Model::Walk})
            EXPECT_THROW(measure_substrate(stack, substrate, one, hemispherical(model, {0})),
                         Error);
    };
    refused({}, conductor(0.4, -1.0, 0.1));
    refused({}, conductor(0.0, 1.0, 0.1));
    refused({}, conductor(0.4, 1.0, 1.5));
    refused({}, conductor(0.4, std::nan(""), 0.1));
    refused({{layer(-1.5)}}, oren_nayar(0.5, 0.0));
    Layer flaked = layer(1.5);
    flaked.flakes = Flakes{1.5, {}};
    refused({{flaked}}, oren_nayar(0.5, 0.0));
    Layer filmed = layer(1.5);
    filmed.film = ThinFilm{-10.0};
    refused({{filmed}}, oren_nayar(0.5, 0.0));
    Layer forward = layer(1.5);
    forward.anisotropy = 1.0;
    refused({{forward}}, oren_nayar(0.5, 0.0));
}

TEST(LobeQuadrature, ResolvesLobesOfAnyWidth) {
    const auto facets_above = [](double alpha, const Vec3& wi) {
        return integrate_about_mirror(wi, [&](const Vec3& wo) {
            const Vec3 h = kernels::vec3_normalise(kernels::vec3_add(wi, wo));
            return kernels::microfacet_pdf(MICROFACET_BECKMANN, alpha, wi, h) /
                   (4.0 * kernels::vec3_dot(wi, h) * wo.z);
        });
    };
    for (const double alpha : {1e-4, 0.01, 0.3, 1.0}) {
        // at the normal, facets within 45 degrees send light up: 1 - exp(-tan^2 45 / alpha^2)
        EXPECT_NEAR(facets_above(alpha, direction_at(1.0, 0.0)),
                    -std::expm1(-1.0 / (alpha * alpha)), 1e-8)
            << alpha;
    }
    for (const double alpha : {1e-4, 0.01}) // too narrow for any to go down
        EXPECT_NEAR(facets_above(alpha, direction_at(cos_deg(70), 0.7)), 1.0, 1e-8) << alpha;
}

TEST(LobeQuadrature, CoversTheHemisphereOnce) {
    for (const double theta : {0.0, 30.0, 60.0, 89.9}) {
        EXPECT_NEAR(integrate_about_mirror(direction_at(cos_deg(theta), 0.3),
                                           [](const Vec3&) { return M_1_PI; }),
                    1.0, 1e-6)
            << theta;
    }
}
