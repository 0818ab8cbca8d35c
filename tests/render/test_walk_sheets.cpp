// Sheets by the renderer's walk, lit from both sides and seen from both.
#include "tests/render/walk_truth.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

Material sheet(std::vector<Layer> layers, double alpha_below, Scattering scattering) {
    Material made = material(std::move(layers), 0.0);
    made.substrate.type = SubstrateType::None;
    made.stack.lower_face = LowerFace{Distribution::Ggx, alpha_below, scattering};
    return made;
}
Material sheet(std::vector<Layer> layers, double alpha_below = 0.0) {
    return sheet(std::move(layers), alpha_below, Scattering::Multiple);
}

Layer dyed(Layer of) {
    of.dyes = {{.absorption = Spectrum::table({400, 460, 540}, {0, 1, 0}),
                .concentration = 1.0,
                .emission = Spectrum::gaussian(540.0, 30.0, 1.0),
                .quantum_yield = 0.9,
                .shares = nullptr}};
    of.absorption = Spectrum::constant(0.05); // or guided light would go on for long
    return of;
}

/// Rough on either side or within, cloudy and dyed ones; most differ from above and from below.
std::vector<Material> sheets() {
    Material cavities =
        sheet({tinted(rough(1.5, 0.4, Distribution::Blinn, Scattering::Multiple))}, 0.3);
    cavities.stack.lower_face->distribution = Distribution::Blinn;
    return {sheet({tinted(layer(1.5, 0.3))}, 0.2),
            sheet({layer(1.5, 0.4)}),
            sheet({tinted(layer(1.6))}, 0.4),
            sheet({layer(1.3), layer(1.6, 0.3), tinted(layer(1.4))}),
            sheet({clouded(layer(1.4), 0.6)}),
            sheet({layer(1.5, 0.2), tinted(clouded(layer(1.3), 0.0))}, 0.3),
            sheet({single(1.5, 0.3)}, 0.3, Scattering::Single),
            cavities,
            sheet({dyed(layer(1.5))}),
            sheet({layer(1.3, 0.2), dyed(clouded(layer(1.5), 0.4))}, 0.3)};
}

/// Renders the sheets from above or from beneath.
RenderResult render_sheets(const Lighting& lighting, bool from_below, std::uint32_t samples) {
    Scene scene = strips_scene(sheets());
    for (Shape& shape : scene.shapes)
        if (auto* strip = std::get_if<RectangleShape>(&shape.geometry); strip && from_below)
            std::swap(strip->edge_u, strip->edge_v);
    scene.lights = lighting.lights;
    scene.images = lighting.images;
    scene.integrator.max_depth = 1;
    add_what_is_not_seen(scene);
    RenderOptions options;
    options.bands = bands;
    options.samples = is_full_run() ? 16 * samples : samples;
    options.model = Model::Walk;
    options.wavelengths.centred = true;
    return render(scene, device(), options);
}

kernels::Vec3 turned_over(const kernels::Vec3& w) {
    return kernels::vec3(w.x, w.y, -w.z);
}

void expect_truth(double light_deg, double azimuth_deg, bool from_below) {
    const std::vector<Material> materials = sheets();
    const Lighting lighting = {{directional(light_deg, azimuth_deg, Spectrum::constant(1.0))}};
    const RenderResult result = render_sheets(lighting, from_below, 64);
    kernels::Vec3 wi = direction_deg(light_deg, azimuth_deg), wo = direction_deg(view_deg);
    if (from_below) {
        wi = turned_over(wi);
        wo = turned_over(wo);
    }
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const WalkedTruth truth = walked_truth(materials[m], wi, wo);
        for (const int band : {2, 7, 13}) {
            const BandStatistics found = strip_statistics(result.image, static_cast<int>(m), band);
            const double expected = truth.value(band);
            const double error = std::sqrt(square(found.standard_error) + truth.variance(band));
            // walks of `measure` that take up blue light seldom send out a band that is dim
            EXPECT_NEAR(found.mean, expected,
                        sidak_bound(comparisons) * error + 2e-4 * expected + 2e-5)
                << "sheet " << m << ", band " << band << ", standard error " << error;
            EXPECT_LT(error, 0.25 * expected + 5e-4) << "sheet " << m << ", band " << band;
        }
    }
}

TEST(WalkedSheets, LitFromAboveTheyMatchTheDoublePrecisionWalk) {
    expect_truth(35.0, 60.0, false);
    expect_truth(35.0, 60.0, true);
}

TEST(WalkedSheets, LitFromBeneathTheyMatchTheDoublePrecisionWalk) {
    expect_truth(140.0, 165.0, false);
    expect_truth(140.0, 165.0, true);
}

/// Two estimators of the same radiance: an environment that is found by chance, and one that is an
/// image and looked for, and found too.
TEST(WalkedSheets, LightsLookedForAndLightsFoundAgree) {
    for (const bool from_below : {false, true}) {
        const RenderResult found = render_sheets(sky, from_below, 64);
        const RenderResult looked_for = render_sheets(sky_image(), from_below, 64);
        for (std::size_t m = 0; m < sheets().size(); ++m)
            for (const int band : {2, 7, 13}) {
                const BandStatistics a = strip_statistics(found.image, static_cast<int>(m), band);
                const BandStatistics b =
                    strip_statistics(looked_for.image, static_cast<int>(m), band);
                const double error = std::hypot(a.standard_error, b.standard_error);
                EXPECT_NEAR(a.mean, b.mean, sidak_bound(comparisons) * error + 1e-5)
                    << "sheet " << m << ", band " << band << ", standard error " << error;
            }
    }
}

} // namespace
} // namespace reradiant
