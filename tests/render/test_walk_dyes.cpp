#include "tests/render/walk_truth.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

/// Takes light from blue to green and yellow, with some of it absorbed again. Nothing outside the
/// film's bands excites it.
SlabDye dye(double concentration) {
    return {.absorption = Spectrum::table({400, 460, 540}, {0, 1, 0}),
            .concentration = concentration,
            .emission = Spectrum::gaussian(540.0, 30.0, 1.0),
            .quantum_yield = 0.9,
            .shares = nullptr};
}

Layer dyed(Layer of, double concentration) {
    of.dyes = {dye(concentration)};
    return of;
}

std::vector<Material> dyed_materials() {
    Layer two = dyed(layer(1.4), 0.5);
    two.dyes.push_back({.absorption = Spectrum::table({490, 550, 630}, {0, 1, 0}),
                        .concentration = 1.0,
                        .emission = Spectrum::gaussian(620.0, 25.0, 1.0),
                        .quantum_yield = 0.8,
                        .shares = nullptr});
    // Light that the slab beneath reflects totally goes to and fro in these two until something
    // absorbs it. Only dyes would, which are clear where they emit: that takes too long to see.
    Layer guiding = two;
    guiding.absorption = Spectrum::constant(0.05);
    return {over_grey({dyed(layer(1.5), 1.0)}),
            over_grey({dyed(layer(1.5, 0.3), 2.0)}),
            over_fluorescent({dyed(tinted(layer(1.5)), 0.5)}),
            over_grey({dyed(clouded(layer(1.4, 0.2), 0.5), 1.0)}),
            over_fluorescent({dyed(layer(1.3, 0.2), 0.5), two}),
            over_grey({layer(1.6), guiding, layer(1.2)}),
            gold_under({dyed(layer(1.5), 1.0)}, 0.4),
            plaster_under({dyed(layer(1.3), 1.0)})};
}

TEST(WalkDyes, MatchTheDoublePrecisionWalk) {
    const std::vector<Material> materials = dyed_materials();
    const RenderResult result = render_strips(materials, sun, Model::Walk, 64);
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const WalkedTruth truth =
            walked_truth(materials[m], direction_deg(35.0, 60.0), direction_deg(view_deg));
        for (int band = 0; band < bands.count; ++band) {
            const BandStatistics found = strip_statistics(result.image, static_cast<int>(m), band);
            const double expected = truth.value(band);
            const double error = std::sqrt(square(found.standard_error) + truth.variance(band));
            EXPECT_NEAR(found.mean, expected, sidak_bound(comparisons) * error + 2e-4 * expected)
                << "material " << m << ", band " << band << ", standard error " << error;
            EXPECT_LT(error, 0.1 * expected) << "material " << m << ", band " << band;
        }
    }
}

/// Two estimators of the same radiance: an environment that is found by chance, and one that is an
/// image and looked for.
TEST(WalkDyes, LightsLookedForAndLightsFoundAgree) {
    const std::vector<Material> materials = dyed_materials();
    const RenderResult found = render_strips(materials, sky, Model::Walk, 64);
    const RenderResult looked_for = render_strips(materials, sky_image(), Model::Walk, 64);
    for (std::size_t m = 0; m < materials.size(); ++m)
        for (int band = 0; band < bands.count; ++band) {
            const BandStatistics a = strip_statistics(found.image, static_cast<int>(m), band);
            const BandStatistics b = strip_statistics(looked_for.image, static_cast<int>(m), band);
            const double error = std::hypot(a.standard_error, b.standard_error);
            EXPECT_NEAR(a.mean, b.mean, sidak_bound(comparisons) * error + 1e-5)
                << "material " << m << ", band " << band << ", standard error " << error;
        }
}

} // namespace
} // namespace reradiant
