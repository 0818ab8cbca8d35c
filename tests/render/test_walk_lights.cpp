#include "tests/render/walk_strips.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

/// Stands where the view is mirrored, under some 0.03 sr.
const RectangleLight lamp{{-8, 7, 0}, {0, 2, 0}, {0, 0, 2}, Spectrum::constant(9.0)};

/// The lamp, and others that light nothing but are looked for as often as it is.
Lighting lamp_among(int others) {
    Lighting lighting{{lamp}};
    for (int i = 0; i < others; ++i)
        lighting.lights.push_back(
            RectangleLight{{-8, -70, 0}, {0, 2, 0}, {0, 0, 2}, Spectrum::constant(9.0)});
    return lighting;
}

Material foil(std::vector<Layer> coats, double alpha, Distribution distribution) {
    Material result = gold_under(std::move(coats), alpha);
    result.substrate.conductor.distribution = distribution;
    return result;
}

/// Metals under one coat, in lobes much narrower than the lamp up to much wider ones.
std::vector<Material> metals_under_coats() {
    std::vector<Material> materials;
    for (const double alpha : {0.01, 0.03, 0.1})
        for (const Distribution distribution : {Distribution::Ggx, Distribution::Blinn}) {
            materials.push_back(foil({}, alpha, distribution));
            materials.push_back(foil({layer(1.5)}, alpha, distribution));
            materials.push_back(
                foil({rough(1.5, 0.05, distribution, Scattering::Multiple)}, alpha, distribution));
            materials.push_back(
                foil({tinted(single(1.5, 0.2, distribution))}, alpha, distribution));
        }
    return materials;
}

std::vector<Material> other_walks() {
    std::vector<Material> materials;
    for (const double alpha : {0.01, 0.1}) {
        materials.push_back(over_fluorescent({layer(1.5, alpha)}));
        materials.push_back(gold_under({layer(1.5, alpha)}, 0.0));
        materials.push_back(over_grey({layer(1.3), single(1.7, alpha)}));
    }
    materials.push_back(plaster_under({layer(1.3, 0.1)}));
    materials.push_back(over_grey({clouded(layer(1.5, 0.1), 0.9), layer(1.2)}));
    materials.push_back(gold_under({layer(1.6, 0.1), layer(1.2), layer(1.5, 0.1)}, 0.05));
    return materials;
}

/// A lamp that is looked for by every path is seen by connections, one that is looked for by one
/// path in 500 by chance: the picture is the same where the weights of the two add up to one.
TEST(WalkLights, PictureDoesNotDependOnHowOftenALampIsLookedFor) {
    std::vector<Material> materials = metals_under_coats();
    for (const Material& material : other_walks())
        materials.push_back(material);
    const RenderResult often = render_strips(materials, lamp_among(0), Model::Walk, 128);
    const RenderResult seldom = render_strips(materials, lamp_among(499), Model::Walk, 512);
    EXPECT_EQ(often.non_finite + seldom.non_finite, 0u);
    for (std::size_t m = 0; m < materials.size(); ++m)
        for (const int band : {2, 13}) {
            const BandStatistics a = strip_statistics(often.image, static_cast<int>(m), band);
            const BandStatistics b = strip_statistics(seldom.image, static_cast<int>(m), band);
            const double error = std::hypot(a.standard_error, b.standard_error);
            // 2.5 % at most are seen; by connections alone half were above 7 %, some at 30 %
            EXPECT_LT(b.standard_error, 0.05 * b.mean) << "material " << m;
            EXPECT_NEAR(a.mean, b.mean, test::sidak_bound(comparisons) * error)
                << "material " << m << ", band " << band << ", standard error " << error;
        }
}

/// Adding is exact for one interface over a diffuse substrate: for the highlight of the lamp in it,
/// from much narrower than the lamp to much wider, and for what comes from below.
TEST(WalkLights, HighlightsOfOneInterfaceAreThoseOfAdding) {
    std::vector<Material> materials;
    for (const double alpha : {0.0, 0.01, 0.03, 0.1}) {
        materials.push_back(material({single(1.5, alpha)}, 0.0));
        materials.push_back(over_fluorescent({tinted(single(1.5, alpha))}));
        materials.push_back(over_grey({layer(1.5, alpha)}));
    }
    RenderOptions other_seed;
    other_seed.seed = 1;
    const RenderResult walk = render_strips(materials, lamp_among(0), Model::Walk, 256);
    const RenderResult adding =
        render_strips(materials, lamp_among(0), Model::Adding, 256, other_seed);
    for (std::size_t m = 0; m < materials.size(); ++m)
        for (const int band : {2, 13}) {
            const BandStatistics a = strip_statistics(walk.image, static_cast<int>(m), band);
            const BandStatistics b = strip_statistics(adding.image, static_cast<int>(m), band);
            const double error = std::hypot(a.standard_error, b.standard_error);
            // the tables of rough interfaces are sampled themselves, to about 0.1 %
            EXPECT_NEAR(a.mean, b.mean, test::sidak_bound(comparisons) * error + 1e-3 * b.mean)
                << "material " << m << ", band " << band << ", standard error " << error;
        }
}

} // namespace
} // namespace reradiant
