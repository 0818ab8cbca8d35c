#include "host/view/tables/variant_grid.h"
#include "reradiant/paths.h"
#include "reradiant/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace reradiant {

namespace {

const WavelengthGrid bands{400.0, 10.0, 31};

Material preset(const std::string& name) {
    return load_material(spectra_directory() / "materials" / (name + ".toml"));
}

double depth_of(const StackElements& stack) {
    double sum = 0.0;
    for (const StackElement& element : stack)
        if (const auto* slab = std::get_if<SlabValues>(&element))
            sum += slab->tau;
    return sum;
}

} // namespace

// One slab absorbs, by another depth in every band: tables along the depth serve all bands.
TEST(VariantGrid, BandsThatDifferInOneDepthAreOneClass) {
    const VariantGrid grid = variant_grid(preset("red-lacquer"), bands, {});
    EXPECT_EQ(grid.bases.size(), 1u);
    EXPECT_GT(grid.nodes.size(), 4u);
    EXPECT_EQ(grid.nodes.front(), 0.0);
    const double largest = *std::max_element(grid.depths.begin(), grid.depths.end());
    EXPECT_DOUBLE_EQ(grid.nodes.back(), 16.0 * largest);
    EXPECT_EQ(grid.variants(), grid.alphas.size() * grid.nodes.size());
}

TEST(VariantGrid, StackOfAVariantHasItsDepthAndWidth) {
    const VariantGrid grid = variant_grid(preset("red-lacquer"), bands, {});
    const std::size_t node = 3, alpha = 2;
    const StackElements stack = grid.stack(alpha * grid.nodes.size() + node);
    EXPECT_DOUBLE_EQ(depth_of(stack), grid.nodes[node]);
    EXPECT_DOUBLE_EQ(std::get<SurfaceValues>(stack.front()).alpha, grid.alphas[alpha]);
}

TEST(VariantGrid, OwnWidthIsAmongThoseOfTheSlider) {
    const Material rough = preset("fluorescent-orange-rough");
    const VariantGrid grid = variant_grid(rough, bands, {});
    EXPECT_DOUBLE_EQ(grid.alphas[grid.own_alpha], rough.stack.layers.front().alpha);
    EXPECT_TRUE(std::is_sorted(grid.alphas.begin(), grid.alphas.end()));
}

TEST(VariantGrid, WithoutSlidersTheMaterialStandsAlone) {
    const VariantGrid grid = variant_grid(preset("house-paint"), bands, {.with_sliders = false});
    EXPECT_EQ(grid.variants(), 1u);
}

// A film interferes by wavelength, and its interface keeps its width.
TEST(VariantGrid, FilmsMakeEveryBandAClassOfItsOwn) {
    const VariantGrid grid = variant_grid(preset("soap-film"), bands, {});
    EXPECT_EQ(grid.bases.size(), static_cast<std::size_t>(bands.count));
    EXPECT_EQ(grid.alphas.size(), 1u);
}

TEST(VariantGrid, CloudsKeepTheirThickness) {
    const VariantGrid grid = variant_grid(preset("silver-paint"), bands, {});
    EXPECT_EQ(grid.nodes, std::vector<double>{1.0});
}

} // namespace reradiant
