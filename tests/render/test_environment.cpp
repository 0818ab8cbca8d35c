#include "host/spectral/colour/rgb_basis.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

using namespace test;
using std::numbers::pi;

const WavelengthGrid bands = grid_from_range(450, 650, 100);

Image plain_image(int width, int height, float value) {
    Image image;
    image.width = width;
    image.height = height;
    image.rgb.assign(static_cast<std::size_t>(3 * width * height), value);
    return image;
}

void set_texel(Image& image, int row, int column, const std::array<float, 3>& rgb) {
    for (std::size_t c = 0; c < 3; ++c)
        image.rgb[3 * static_cast<std::size_t>(row * image.width + column) + c] = rgb[c];
}

void light_by(Scene& scene, const Image& image, double rotation_deg = 0.0) {
    scene.images = {image};
    scene.lights = {EnvironmentLight{Spectrum::constant(1.0), 0, rotation_deg}};
}

RenderResult rendered(const Scene& scene, std::uint32_t samples) {
    RenderOptions options;
    options.bands = bands;
    options.samples = samples;
    options.wavelengths.centred = true;
    options.all_features = true; // the program of test_materials.cpp, built once
    return render(scene, device(), options);
}

TEST(EnvironmentImage, ConstantImageIsTheConstantEnvironment) {
    // the basis adds up to 1, so that white stands for the light's own spectrum
    for (const Material& m :
         {material({}, 0.8), material({layer(1.5, 0.2)}, 0.5), material({layer(1.5)}, 0.5)}) {
        Scene scene = plane_scene(m, 40.0, 12, 12);
        scene.lights = {environment(Spectrum::constant(2.0))};
        const RenderResult constant = rendered(scene, 128);
        light_by(scene, plain_image(16, 8, 2.0f));
        const RenderResult image = rendered(scene, 128);
        for (int band = 0; band < bands.count; ++band) {
            const BandStatistics a = band_statistics(constant.image, band);
            const BandStatistics b = band_statistics(image.image, band);
            EXPECT_NEAR(a.mean, b.mean,
                        test::sidak_bound(3 * bands.count) *
                                std::hypot(a.standard_error, b.standard_error) +
                            1e-5);
        }
    }
}

/// Returns the radiance by band that a camera at the origin sees in the direction `towards`.
std::vector<double> seen(const Image& image, const Vector3& towards, double rotation_deg) {
    Scene scene = plane_scene(material({}, 0.5), 0.0, 2, 2);
    scene.shapes = {{SphereShape{{0, -1000, 0}, 1.0}, 0}}; // nothing in the way
    scene.camera.origin = {0, 0, 0};
    scene.camera.target = towards;
    scene.camera.up = std::abs(towards[1]) > 0.9 ? Vector3{0, 0, 1} : Vector3{0, 1, 0};
    light_by(scene, image, rotation_deg);
    const RenderResult result = rendered(scene, 4);
    std::vector<double> radiance;
    for (int band = 0; band < bands.count; ++band)
        radiance.push_back(band_statistics(result.image, band).mean);
    return radiance;
}

TEST(EnvironmentImage, LooksWhereItsRowsAndColumnsSay) {
    // red above, blue on the right of the middle column, green in the middle, black elsewhere
    Image image = plain_image(16, 8, 0.0f);
    for (int column = 0; column < 16; ++column)
        for (int row = 0; row < 2; ++row)
            set_texel(image, row, column, {3, 0, 0});
    for (int row = 3; row < 5; ++row) {
        for (const int column : {7, 8})
            set_texel(image, row, column, {0, 2, 0});
        for (const int column : {11, 12})
            set_texel(image, row, column, {0, 0, 1});
    }
    const auto expect_colour = [&](const Vector3& towards, double rotation, std::size_t primary,
                                   double value, const char* what) {
        const std::vector<double> found = seen(image, towards, rotation);
        for (int band = 0; band < bands.count; ++band)
            EXPECT_NEAR(found[static_cast<std::size_t>(band)],
                        value * rgb_basis()[primary](bands.centre_nm(band)), 1e-5)
                << what << ", band " << band;
    };
    expect_colour({0, 1, 0}, 0, 0, 3, "up");
    expect_colour({0, 0, -1}, 0, 1, 2, "the middle column");
    expect_colour({1, 0, 0}, 0, 2, 1, "a quarter to its right");
    expect_colour({0, 0, 1}, 0, 0, 0, "behind");
    expect_colour({-1, 0, 0}, 90, 1, 2, "turned right-handed by a quarter: the middle column");
}

TEST(EnvironmentImage, SunInATexelIsSampledAndLightsByItsSolidAngle) {
    Image image = plain_image(64, 32, 0.1f);
    constexpr int row = 8, column = 20;
    set_texel(image, row, column, {1e5f, 1e5f, 1e5f});
    const auto scene_of = [&](const Material& m) {
        Scene scene = plane_scene(m, 30.0, 8, 8);
        scene.integrator.max_depth = 1;
        light_by(scene, image);
        return scene;
    };
    // Bilinear: a hat of two texels' width. Irradiance by the midpoint rule, fine enough for 1e-5.
    constexpr int fine = 400;
    double irradiance = 0.1 * pi;
    for (int j = 0; j < 2 * fine; ++j)
        for (int i = 0; i < 2 * fine; ++i) {
            const double y = (j + 0.5) / fine - 1.0, x = (i + 0.5) / fine - 1.0;
            const double theta = pi * (row + 0.5 + y) / 32;
            irradiance += (1e5 - 0.1) * (1 - std::abs(x)) * (1 - std::abs(y)) * std::cos(theta) *
                          std::sin(theta) * (pi / 32) * (2 * pi / 64) / (fine * fine);
        }
    const RenderResult result = rendered(scene_of(material({}, 1.0)), 64);
    EXPECT_EQ(result.non_finite, 0u);
    for (int band = 0; band < bands.count; ++band) {
        const BandStatistics found = band_statistics(result.image, band);
        const double expected = irradiance / pi;
        EXPECT_NEAR(found.mean, expected, test::sidak_bound(bands.count) * found.standard_error);
        // 4096 samples of a density that is constant on a texel under a hat: 0.7 / 64 at most.
        // Found by chance alone the texel would leave an error above the value itself.
        EXPECT_LT(found.standard_error, 0.02 * expected);
    }
}

TEST(EnvironmentImage, ABlackImageIsBlack) {
    Scene scene = plane_scene(material({}, 1.0), 30.0, 4, 4);
    light_by(scene, plain_image(8, 4, 0.0f));
    const RenderResult result = rendered(scene, 2);
    EXPECT_EQ(result.non_finite, 0u);
    EXPECT_EQ(band_statistics(result.image, 0).mean, 0.0);
}

} // namespace
} // namespace reradiant
