#include "reradiant/error.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene_file.h"
#include "tests/render/test_scenes.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string_view>

namespace reradiant {
namespace {

using namespace test;

struct Case {
    const char* name;
    Scene scene;
    Model model = Model::Auto;
};

ReradiationMatrix unfactored_matrix() {
    ReradiationMatrix matrix = shifted_matrix();
    for (int i = 0; i + 7 < matrix.emission.count; ++i)
        matrix.values(i + 7, i) += 0.02 + 0.003 * i;
    return matrix;
}

Scene lit_sphere(const Material& m, const std::vector<Light>& lights) {
    Scene scene = sphere_scene(m, 24, 24);
    scene.lights = lights;
    scene.film.bands = grid_from_range(400, 700, 20);
    return scene;
}

/// Every way through the kernel: both forms of the matrix, both models, the first bounce of
/// Oren-Nayar, wavelengths that disperse, lines, and shifts one after another.
std::vector<Case> cases() {
    const Light white = environment(Spectrum::constant(1.0));
    Spectrum mercury = Spectrum::line(436.0, 1.0, 20.0);
    mercury += Spectrum::line(546.0, 1.0, 20.0);
    const Light lines = RectangleLight{{0, 1, 4}, {2, 0, 0}, {0, 2, 0}, mercury};
    const Spectrum falling = Spectrum::table({400, 700}, {1.62, 1.48});
    Layer dispersive = layer(1.5, 0.3, 0.2);
    dispersive.ior = falling;
    Material rough = fluorescent({layer(1.5, 0.3, 0.4)}, shifted_matrix());
    rough.substrate.type = SubstrateType::OrenNayar;
    rough.substrate.sigma = 0.5;
    Scene bounces = lit_sphere(rough, {lines});
    bounces.shapes.push_back({RectangleShape{{0, -1, 0}, {0, 0, 8}, {8, 0, 0}}, 0});
    return {{"white furnace", lit_sphere(material({layer(1.5, 0.4)}, 1.0), {white})},
            {"furnace of a factored matrix",
             lit_sphere(fluorescent({layer(1.5)}, shifted_matrix()), {white})},
            {"dense matrix under lines",
             lit_sphere(fluorescent({layer(1.5)}, unfactored_matrix()), {lines})},
            {"dispersive layer, model A",
             lit_sphere(fluorescent({dispersive}, shifted_matrix()), {white, lines}),
             Model::WeidlichWilkie},
            {"shifts one after another", bounces}};
}

SpectralImage rendered(const Case& one, int hero, std::uint32_t samples, std::uint32_t seed) {
    RenderOptions options;
    options.samples = samples;
    options.seed = seed;
    options.model = one.model;
    options.wavelengths.hero_count = hero;
    const RenderResult result = render(one.scene, device(), options);
    EXPECT_EQ(result.non_finite, 0u) << one.name;
    EXPECT_EQ(result.features.at("hero"), hero > 0);
    return result.image;
}

/// Mean over the image of hero minus comb in every band, by the spread of pixels' differences; a
/// bias of 1 % lies beyond Sidak's bound in the sum of bands of most cases (standard errors of
/// 0.1 to 1 % a band).
void expect_agreement(const Case& one, int hero, std::uint32_t samples) {
    const SpectralImage comb = rendered(one, 0, samples, 1);
    SpectralImage difference = rendered(one, hero, 4 * samples, 2);
    ASSERT_EQ(comb.values.size(), difference.values.size());
    for (std::size_t i = 0; i < comb.values.size(); ++i)
        difference.values[i] -= comb.values[i];
    const double bound = test::sidak_bound(comb.bands.count * 50);
    for (int band = 0; band < comb.bands.count; ++band) {
        const BandStatistics found = band_statistics(difference, band);
        // Single precision: sums of other order.
        EXPECT_LE(std::abs(found.mean),
                  bound * found.standard_error + 1e-5 * std::abs(band_statistics(comb, band).mean))
            << one.name << ", hero:" << hero << ", " << comb.bands.centre_nm(band) << " nm, comb "
            << band_statistics(comb, band).mean;
    }
}

TEST(Hero, Case32AgreesWithTheCombInEveryBand) {
    for (const Case& one : cases()) {
        expect_agreement(one, 4, test::is_full_run() ? 2048 : 128);
        if (test::is_full_run())
            for (const int hero : {1, 7, 16})
                expect_agreement(one, hero, 1024);
    }
}

TEST(Hero, Case30LightFromTheUltravioletAloneIsNotMissed) {
    Case one{"line below the film", lit_sphere(fluorescent({}, shifted_matrix()), {})};
    one.scene.lights = {environment(Spectrum::line(436.0, 1.0, 20.0))};
    one.scene.film.bands = grid_from_range(500, 700, 20);
    const SpectralImage image = rendered(one, 4, 16, 3);
    EXPECT_GT(band_statistics(image, 4).mean, 0.0);
    expect_agreement(one, 4, 128);
}

/// Twice the same wavelength in one set, and more wavelengths asked for than the film has lanes.
TEST(Hero, Case31WavelengthsThatMeetCountOnce) {
    Case one{"two bands",
             lit_sphere(fluorescent({}, shifted_matrix()), {environment(Spectrum::constant(1.0))})};
    one.scene.film.bands = WavelengthGrid{580.0, 40.0, 2};
    expect_agreement(one, 8, 128);
}

TEST(Hero, ImageDependsOnTheSeedAlone) {
    const Case one = cases().back();
    RenderOptions options;
    options.samples = 8;
    options.wavelengths.hero_count = 6;
    const SpectralImage whole = render(one.scene, device(), options).image;
    options.batch_paths = 1000;
    options.threads = 1;
    EXPECT_EQ(render(one.scene, device(), options).image.values, whole.values);
    options.seed = 7;
    EXPECT_NE(render(one.scene, device(), options).image.values, whole.values);
}

TEST(Hero, WalkIsRefused) {
    Case one = cases().front();
    one.model = Model::Walk;
    one.scene.file = "scene.toml";
    EXPECT_THROW(rendered(one, 4, 1, 0), Error);
}

/// The scenes that come with the program, small. The comb alone takes a second each.
TEST(Hero, AgreesWithTheCombInTheExamples) {
    if (!test::is_full_run())
        GTEST_SKIP() << "a full run renders every example scene";
    const std::filesystem::path folder =
        std::filesystem::path(RERADIANT_SOURCE_DIR) / "tools" / "examples";
    for (const char* name : {"furnace", "fluorescent-bare", "fluorescent-bare-405",
                             "fluorescent-smooth", "fluorescent-smooth-405", "fluorescent-rough",
                             "fluorescent-rough-405", "uv-only", "presets"}) {
        Case one{name, load_scene(folder / (std::string(name) + ".toml"))};
        // `auto` walks through some of these for comb, which hero cannot: one model for both.
        if (std::string_view(name) == "presets")
            one.model = Model::WeidlichWilkie;
        one.scene.film.width = 32;
        one.scene.film.height = 24;
        expect_agreement(one, 4, 512);
    }
}

} // namespace
} // namespace reradiant
