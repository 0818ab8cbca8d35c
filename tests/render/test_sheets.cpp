// Light through sheets: what is seen and looked for straight through smooth ones.
#include "host/layers/models/layered_bsdf.h"
#include "host/scene/model/closed_model.h"
#include "kernels/core/shared.h"
#include "tests/render/test_scenes.h"
#include "tests/support/directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

using namespace test;

const WavelengthGrid bands = grid_from_range(450, 650, 100);

Material glass(double ior, const Spectrum& absorption) {
    Layer slab = layer(ior);
    slab.absorption = absorption;
    Material m = material({slab}, 0.0);
    m.substrate.type = SubstrateType::None;
    m.stack.lower_face = LowerFace{};
    return m;
}

/// Lays a sheet over the plane at a height.
void lay_over(Scene& scene, const Material& sheet, double height) {
    scene.materials.push_back(sheet);
    scene.shapes.push_back({RectangleShape{{0, height, 0}, {0, 0, 1000}, {1000, 0, 0}},
                            static_cast<int>(scene.materials.size()) - 1});
}

RenderOptions options_of(std::uint32_t samples, bool all_features = true) {
    RenderOptions options;
    options.bands = bands;
    options.samples = samples;
    options.wavelengths.centred = true;
    options.all_features = all_features;
    return options;
}

TEST(Sheets, AFilterGlassBeforeALampTakesWhatItAbsorbs) {
    const Material tinted = glass(1.5, Spectrum::table({400, 700}, {0.1, 1.2}));
    const double c = std::cos(radians(30.0));
    const LayeredBsdf bsdf(tinted.stack, {}, bands, closed_model(Model::Adding));
    const Eigen::VectorXd through = bsdf.straight_on(c);
    for (const int sheets : {1, 2, 3})
        for (const bool all_features : {false, true}) {
            Scene scene = plane_scene(material({}, 0.5), 40.0, 8, 8);
            scene.lights = {directional(30.0, 90.0, Spectrum::constant(1.0))};
            // what sheets mirror to and fro of a lamp without size no path finds
            scene.integrator.max_depth = sheets + 1;
            for (int k = 0; k < sheets; ++k)
                lay_over(scene, tinted, 20.0 + k);
            const RenderResult result = render(scene, device(), options_of(2, all_features));
            for (int band = 0; band < bands.count; ++band) {
                const double expected =
                    0.5 * std::numbers::inv_pi * c * std::pow(through(band), sheets);
                const double found = band_statistics(result.image, band).mean;
                EXPECT_NEAR(found, expected, 3e-4 * expected) << sheets << ", band " << band;
            }
        }
}

/// Sheets that nothing happens at change nothing, however many lie before the lamp and the camera:
/// lights behind them are looked for and met.
TEST(Sheets, ThoseThatAreNotSeenChangeNothing) {
    const Material nothing = glass(1.0, Spectrum());
    const auto rendered = [&](int sheets, bool small) {
        Scene scene = plane_scene(material({}, 0.5), 40.0, 16, 16);
        const double size = small ? 0.5 : 8.0;
        scene.lights = {
            RectangleLight{{0, 6, 0}, {size, 0, 0}, {0, 0, size}, Spectrum::constant(1.0)}};
        scene.integrator.max_depth = 2 * sheets + 2;
        scene.integrator.min_depth = 20;
        for (int k = 0; k < sheets; ++k)
            lay_over(scene, nothing, 1.0 + 0.5 * k);
        return render(scene, device(), options_of(256)).image;
    };
    for (const bool small : {true, false}) {
        const BandStatistics without = band_statistics(rendered(0, small), 1);
        EXPECT_GT(without.mean, 0.0);
        for (const int sheets : {1, 2, 6}) {
            if (small && sheets > MOST_CROSSINGS)
                continue; // found by chance alone
            const BandStatistics with = band_statistics(rendered(sheets, small), 1);
            EXPECT_NEAR(with.mean, without.mean,
                        sidak_bound(5) * std::hypot(with.standard_error, without.standard_error))
                << sheets << " sheets, small " << small;
        }
    }
}

} // namespace
} // namespace reradiant
