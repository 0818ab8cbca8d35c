#include "host/layers/walk/walk_estimate.h"
#include "tests/render/walk_strips.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

std::vector<Material> plain_materials() {
    Material foil =
        gold_under({tinted(rough(1.4, 0.3, Distribution::Beckmann, Scattering::Single))}, 0.4);
    foil.substrate.conductor.scattering = Scattering::Single;
    foil.substrate.conductor.distribution = Distribution::Blinn;
    Layer cloud = layer(1.4, 0.2, 0.2);
    cloud.scattering_coefficient = Spectrum::constant(1.5);
    cloud.anisotropy = 0.6;
    return {over_grey({layer(1.5, 0.5)}),
            over_grey({rough(2.0, 0.3, Distribution::Beckmann, Scattering::Multiple)}),
            over_grey({single(1.5, 0.3, Distribution::Blinn)}),
            over_grey({layer(1.6, 0.3), layer(1.2)}),
            over_grey({layer(1.3), layer(1.6, 0.4), layer(1.3, 0.2)}),
            over_grey({cloud}),
            over_grey({cloud, layer(1.8, 0.1), layer(1.2)}),
            gold_under({layer(1.5, 0.2)}, 0.4),
            foil,
            gold_under({layer(1.5, 0.2)}, 0.0),
            plaster_under({layer(1.3, 0.2)})};
}

Layer cavities(double ior, double alpha) {
    return rough(ior, alpha, Distribution::Blinn, Scattering::Multiple);
}

Layer flaked(Layer of, double coverage, double alpha, Distribution distribution,
             Scattering scattering) {
    of.flakes = Flakes{coverage, gold_under({}, alpha).substrate.conductor};
    of.flakes->reflector.distribution = distribution;
    of.flakes->reflector.scattering = scattering;
    return of;
}

/// V-cavities that give back what they lose, and sheets of flakes.
std::vector<Material> cavities_and_flakes() {
    Material foil = gold_under({tinted(cavities(1.5, 0.3))}, 0.5);
    foil.substrate.conductor.distribution = Distribution::Blinn;
    const Layer ggx_flakes =
        flaked(tinted(layer(1.5)), 0.4, 0.3, Distribution::Ggx, Scattering::Multiple);
    const Layer blinn_flakes =
        flaked(layer(1.5), 0.3, 0.4, Distribution::Blinn, Scattering::Multiple);
    const Layer single_flakes = flaked(tinted(clouded(layer(1.4, 0.2), 0.3)), 0.5, 0.3,
                                       Distribution::Ggx, Scattering::Single);
    return {over_grey({cavities(1.5, 0.5)}),
            over_grey({cavities(1.6, 0.3), cavities(1.3, 0.4)}),
            foil,
            over_grey({ggx_flakes}),
            over_grey({layer(1.5), blinn_flakes, layer(1.3)}),
            gold_under({single_flakes}, 0.2),
            over_grey({layer(1.3, 0.2), ggx_flakes, blinn_flakes})};
}

/// Materials that adding has not, or has only on the average over directions.
std::vector<Material> materials_for_the_twin() {
    std::vector<Material> materials = plain_materials();
    for (const Material& material : cavities_and_flakes())
        materials.push_back(material);
    return materials;
}

SubstrateValues twin_substrate(const Substrate& substrate, const std::vector<double>& nm) {
    SubstrateValues twin;
    const auto count = static_cast<Eigen::Index>(nm.size());
    twin.matrix = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
        twin.matrix(i, i) = substrate.reflectance(nm[static_cast<std::size_t>(i)]);
    twin.sigma = substrate.sigma;
    if (substrate.type == SubstrateType::Conductor)
        for (const double wavelength : nm)
            twin.conductor.push_back(conductor_at(substrate.conductor, wavelength));
    return twin;
}

TEST(Walk, MatchesTheDoublePrecisionWalkInAngle) {
    const std::vector<Material> materials = materials_for_the_twin();
    const RenderResult result = render_strips(materials, sun, Model::Walk, 128);
    const auto direction = [](double theta_deg, double phi_deg) {
        const double radian = std::numbers::pi / 180.0, s = std::sin(theta_deg * radian);
        return kernels::vec3(s * std::cos(phi_deg * radian), s * std::sin(phi_deg * radian),
                             std::cos(theta_deg * radian));
    };
    const kernels::Vec3 wi = direction(35.0, 60.0);
    const std::vector<kernels::Vec3> wo = {direction(view_deg, 0.0)};
    const std::vector<int> compared = {2, 13};
    const std::vector<double> nm = {bands.centre_nm(2), bands.centre_nm(13)};
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const LayerWalk walk(materials[m].stack, twin_substrate(materials[m].substrate, nm), nm);
        const WalkEstimate twin =
            estimate_walk(walk, wi, wo, test::is_full_run() ? 1u << 20 : 1u << 14, 3);
        for (std::size_t b = 0; b < nm.size(); ++b) {
            const auto row = static_cast<Eigen::Index>(b);
            const auto sum_of = [&](const WalkTally::Parts& parts, bool squared) {
                const double diffuse = parts.diffuse.row(row).sum(),
                             rest = parts.specular(row) + parts.slab(row);
                return squared ? diffuse * diffuse + rest * rest : diffuse + rest;
            };
            const double expected = sum_of(twin.mean.directional[0], false) * wi.z;
            const double variance = sum_of(twin.standard_error.directional[0], true) * wi.z * wi.z;
            const BandStatistics found =
                strip_statistics(result.image, static_cast<int>(m), compared[b]);
            const double error = std::sqrt(square(found.standard_error) + variance);
            EXPECT_NEAR(found.mean, expected,
                        test::sidak_bound(comparisons) * error + 2e-4 * expected)
                << "material " << m << ", band " << compared[b] << ", standard error " << error;
        }
    }
}

/// An environment that is an image is looked for, a constant one is found by chance: two
/// estimators of the same radiance that share nothing but the walk.
TEST(Walk, LightsLookedForAndLightsFoundAgree) {
    std::vector<Material> materials = materials_for_the_twin();
    for (const Stack& stack : all_stacks())
        materials.push_back(over_fluorescent(stack.layers));
    const RenderResult found = render_strips(materials, sky, Model::Walk, 64);
    const RenderResult looked_for = render_strips(materials, sky_image(), Model::Walk, 128);
    for (std::size_t m = 0; m < materials.size(); ++m)
        for (const int band : {2, 13}) {
            const BandStatistics a = strip_statistics(found.image, static_cast<int>(m), band);
            const BandStatistics b = strip_statistics(looked_for.image, static_cast<int>(m), band);
            const double error = std::hypot(a.standard_error, b.standard_error);
            // the basis of rgb spectra adds up to one to single precision
            EXPECT_NEAR(a.mean, b.mean, test::sidak_bound(comparisons) * error + 1e-5)
                << "material " << m << ", band " << band << ", standard error " << error;
        }
}

} // namespace
} // namespace reradiant
