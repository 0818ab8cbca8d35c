#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

Scene small_scene() {
    Scene scene = sphere_scene(fluorescent({layer(1.5, 0.2)}, shifted_matrix()), 20, 14);
    scene.lights = {environment(Spectrum::constant(0.3)),
                    RectangleLight{{0, 4, 1}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(5.0)}};
    return scene;
}

std::vector<float> rendered(RenderOptions options, const Device& on = device()) {
    options.samples = 11;
    return render(small_scene(), on, options).image.values;
}

TEST(Determinism, SameSeedGivesTheSameImageWhateverTheBatch) {
    const std::vector<float> reference = rendered({});
    for (const std::size_t batch : {std::size_t{13}, std::size_t{300}, std::size_t{1} << 20}) {
        RenderOptions options;
        options.batch_paths = batch;
        EXPECT_EQ(rendered(options), reference) << batch;
    }
}

TEST(Determinism, SameSeedGivesTheSameImageWhateverTheThreads) {
    const std::vector<float> reference = rendered({});
    RenderOptions options;
    options.threads = 1;
    EXPECT_EQ(rendered(options), reference);
}

/// A device with memory of its own maps its buffers, and has nothing to map in the dark: both give
/// the image of shared memory.
TEST(Determinism, MappedMemoryGivesTheImageOfSharedMemory) {
    const Device mapping("", false);
    EXPECT_FALSE(mapping.info().shares_memory);
    EXPECT_EQ(rendered({}, mapping), rendered({}));
    Scene dark = small_scene();
    dark.lights.clear();
    const std::vector<float> black = render(dark, mapping, {}).image.values;
    EXPECT_EQ(black, std::vector<float>(black.size(), 0.0f));
}

TEST(Determinism, AnotherSeedGivesAnotherImage) {
    RenderOptions options;
    options.seed = 1;
    EXPECT_NE(rendered(options), rendered({}));
}

TEST(Determinism, AllFeaturesAgreeWithTheSpecialisedKernels) {
    RenderOptions options;
    options.all_features = true;
    options.wavelengths.keep_all = true;
    const std::vector<float> all = rendered(options), some = rendered({});
    ASSERT_EQ(all.size(), some.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_NEAR(all[i], some[i], 1e-4f * (some[i] + 0.1f)) << i;
}

} // namespace
} // namespace reradiant
