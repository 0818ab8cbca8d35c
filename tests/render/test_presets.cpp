#include "reradiant/paths.h"
#include "reradiant/scene_file.h"
#include "tests/render/walk_strips.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

namespace reradiant {
namespace {

using namespace test;

std::vector<Material> presets() {
    std::vector<Material> materials;
    for (const std::string& name : preset_names()) {
        materials.push_back(load_material(spectra_directory() / "materials" / (name + ".toml")));
        materials.back().name = name;
        if (materials.back().stack.is_sheet()) // of which the renderer makes no pictures
            materials.pop_back();
    }
    return materials;
}

/// Light that a strip sends out under unit radiance from all around, over that of a white one: sums
/// over bands, since what re-radiates moves light from band to band.
BandStatistics returned_share(const SpectralImage& image, int strip) {
    BandStatistics share;
    const int count = image.bands.count;
    for (int band = 0; band < count; ++band) {
        const BandStatistics s = strip_statistics(image, strip, band);
        share.mean += s.mean / count;
        share.standard_error += s.standard_error / count; // bands err together
    }
    return share;
}

/// No preset sends out more than it receives, by the model that `auto` takes, whatever the angle.
TEST(Presets, NoneMakesEnergy) {
    const std::vector<Material> materials = presets();
    ASSERT_GE(materials.size(), 30u);
    const std::vector<double> angles = test::is_full_run()
                                           ? std::vector<double>{0, 20, 40, 60, 75, 85, 89}
                                           : std::vector<double>{10, 75};
    for (const double angle : angles) {
        Scene scene = strips_scene(materials, angle);
        scene.lights = sky.lights;
        scene.integrator.max_depth = 1;
        RenderOptions options;
        options.bands = grid_from_range(300, 780, 10);
        options.samples = test::is_full_run() ? 256 : 32;
        const RenderResult result = render(scene, device(), options);
        EXPECT_EQ(result.non_finite, 0u);
        for (std::size_t i = 0; i < materials.size(); ++i) {
            const BandStatistics share = returned_share(result.image, static_cast<int>(i));
            // tables of reflection by facets are good to 1e-3
            EXPECT_LT(share.mean,
                      1.0 + 1e-3 + test::sidak_bound(comparisons) * share.standard_error)
                << materials[i].name << " at " << angle << " degrees, standard error "
                << share.standard_error;
            EXPECT_GT(share.mean, 0.01) << materials[i].name;
        }
    }
}

} // namespace
} // namespace reradiant
