#include "host/render/tables/scene_tables.h"
#include "host/spectral/colour/rgb_basis.h"
#include "kernels/scene/texture.h"
#include "reradiant/scene_file.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>

namespace reradiant {
namespace {

using namespace test;
using std::numbers::pi;

const WavelengthGrid bands = grid_from_range(450, 650, 100);
constexpr int film = 8;

/// A square of side 2 in the plane y = 0, u along +z and v along +x, that fills the film as seen
/// from above, lit along its normal: radiance = reflectance / pi.
Scene square_scene(std::vector<Material> materials) {
    Scene scene = plane_scene(materials.front(), 0.0, film, film);
    scene.camera.fov_deg = 2.0 * std::atan(0.1) * 180.0 / pi;
    scene.materials = std::move(materials);
    scene.surfaces = plain_surfaces(scene);
    scene.shapes = {{RectangleShape{{0, 0, 0}, {0, 0, 2}, {2, 0, 0}}, 0}};
    scene.lights = {directional(0.0, 0.0, Spectrum::constant(1.0))};
    scene.integrator.max_depth = 1;
    return scene;
}

/// Returns the point of the square that a point of the film shows; x and y run from 0 to 1 from the
/// upper left corner of the film, whose right is -x and whose up is +z.
kernels::Vec3 on_square(double x, double y) {
    return kernels::vec3(1.0 - 2.0 * x, 0.0, 1.0 - 2.0 * y);
}

RenderResult rendered(const Scene& scene, std::uint32_t samples) {
    RenderOptions options;
    options.bands = bands;
    options.samples = samples;
    options.wavelengths.centred = true;
    options.all_features = true; // the program of test_materials.cpp, built once
    return render(scene, device(), options);
}

/// pi times the radiance of a pixel.
double reflectance_at(const RenderResult& result, int x, int y, int band = 0) {
    return pi * static_cast<double>(result.image.at(x, y, band));
}

/// A texture as the kernel evaluates it, in double, at points of the film.
class Evaluated {
public:
    explicit Evaluated(const Scene& scene) { append_surfaces(scene, tables_); }
    kernels::TexturePoint operator()(double x, double y) const {
        const kernels::Vec3 p = on_square(x, y);
        return kernels::texture_at(tables_.textures.front(), p, 0.5 * (p.z + 1.0),
                                   0.5 * (p.x + 1.0), tables_.tables.data());
    }
    double mean(const std::function<double(const kernels::TexturePoint&)>& of) const {
        constexpr int fine = 300;
        double sum = 0.0;
        for (int j = 0; j < fine; ++j)
            for (int i = 0; i < fine; ++i)
                sum += of((*this)((i + 0.5) / fine, (j + 0.5) / fine)) / (fine * fine);
        return sum;
    }

private:
    SceneTables tables_;
};

double value_of(const kernels::TexturePoint& point) {
    return point.value;
}

/// Mean reflectance over the film against the texture's mean: every sample is another point.
void expect_mean(const Scene& scene, double expected, const char* what) {
    const RenderResult result = rendered(scene, 256);
    EXPECT_EQ(result.non_finite, 0u) << what;
    double sum = 0.0, variance = 0.0;
    for (int y = 0; y < film; ++y)
        for (int x = 0; x < film; ++x)
            sum += reflectance_at(result, x, y) / (film * film);
    // pixels differ by more than chance: at most 1/4 is the variance of a number in 0..1
    variance = 0.25 / (film * film * 256);
    EXPECT_NEAR(sum, expected, test::sidak_bound(4) * std::sqrt(variance)) << what;
}

TEST(Textures, CheckerHasBothMaterialsInTheirSquares) {
    Scene scene = square_scene({material({}, 0.2), material({}, 0.2), material({}, 0.8)});
    Texture checker;
    checker.type = TextureType::Checker;
    checker.size = 0.5; // two pixels
    checker.levels = 2;
    scene.textures = {checker};
    scene.surfaces[0].first_material = 1;
    scene.surfaces[0].textures = {0};
    const RenderResult result = rendered(scene, 16);
    for (int y = 0; y < film; ++y)
        for (int x = 0; x < film; ++x) {
            const kernels::Vec3 p = on_square((x + 0.5) / film, (y + 0.5) / film);
            const int square = static_cast<int>(std::floor(2.0 * p.x) + std::floor(2.0 * p.z));
            // a sample in 10^4 falls across an edge
            EXPECT_NEAR(reflectance_at(result, x, y), square % 2 == 0 ? 0.2 : 0.8, 0.1)
                << x << ", " << y;
        }
}

TEST(Textures, MixtureIsTheLinearMix) {
    Scene scene = square_scene({material({}, 1.0), material({}, 0.0)});
    scene.surfaces[0].mixed_with = 1;
    scene.surfaces[0].mix_weight = 0.3;
    expect_mean(scene, 0.7, "mixture");
}

TEST(Textures, LevelsInterpolateLinearlyInExpectation) {
    std::vector<Material> levels{material({}, 0.5)};
    for (const double reflectance : {0.0, 0.25, 0.5, 0.75, 1.0})
        levels.push_back(material({}, reflectance));
    Scene scene = square_scene(levels);
    Texture noise;
    noise.size = 0.3;
    noise.sharpness = 2.0;
    noise.levels = 5;
    scene.textures = {noise};
    scene.surfaces[0].first_material = 1;
    scene.surfaces[0].textures = {0};
    expect_mean(scene, Evaluated(scene).mean(value_of), "noise");
}

TEST(Textures, ImagesLieByUAndVWithTheirFirstRowOnTop) {
    Scene scene = square_scene({material({}, 0.0), material({}, 1.0)});
    scene.images.resize(1);
    scene.images[0].width = scene.images[0].height = 2;
    scene.images[0].rgb.assign(12, 0.0f);
    for (std::size_t c = 0; c < 3; ++c)
        scene.images[0].rgb[c] = 1.0f; // row 0, column 0: u = 1/4, v = 3/4
    Texture picture;
    picture.type = TextureType::Image;
    picture.space = TextureSpace::Uv;
    picture.size = 1.0;
    picture.image = 0;
    scene.textures = {picture};
    scene.surfaces[0].mixed_with = 1;
    scene.surfaces[0].mix_texture = 0;
    EXPECT_NEAR(Evaluated(scene)(0.25, 0.75).value, 1.0, 1e-6); // u = 1/4 is z = -1/2, below
    EXPECT_NEAR(Evaluated(scene)(0.75, 0.75).value, 0.0, 1e-6);
    expect_mean(scene, Evaluated(scene).mean(value_of), "image");
    const RenderResult result = rendered(scene, 64);
    // pixels around the centres of the texels: between 0.77 and 1 by bilinear interpolation
    EXPECT_GT(reflectance_at(result, 2, 6), 0.6);
    EXPECT_LT(reflectance_at(result, 6, 6), 0.3);
    EXPECT_LT(reflectance_at(result, 2, 2), 0.3);
}

TEST(Textures, FlakesTiltTheNormal) {
    Scene scene = square_scene({material({}, 1.0)});
    Texture flakes;
    flakes.type = TextureType::Voronoi;
    flakes.size = 0.2;
    flakes.tilt_deg = 20.0;
    scene.textures = {flakes};
    scene.surfaces[0].normal_texture = 0;
    const Evaluated texture(scene);
    // light from above, then from +x: the tilted normal is (slope_x, 1, -slope_y) / length
    expect_mean(scene, texture.mean([](const kernels::TexturePoint& point) {
        return 1.0 / std::sqrt(1.0 + point.slope_x * point.slope_x + point.slope_y * point.slope_y);
    }),
                "from above");
    scene.lights = {directional(30.0, 0.0, Spectrum::constant(1.0))};
    expect_mean(scene, texture.mean([](const kernels::TexturePoint& point) {
        const double along = 0.5 * point.slope_x + std::sqrt(0.75);
        return std::max(along, 0.0) /
               std::sqrt(1.0 + point.slope_x * point.slope_x + point.slope_y * point.slope_y);
    }),
                "from +x");
}

TEST(Textures, ImageColoursTheReflectanceUnderALayer) {
    Material m = material({layer(1.5)}, 0.9);
    m.substrate.reflectance_image = 0;
    Scene scene = square_scene({m});
    scene.images.resize(1);
    scene.images[0].width = scene.images[0].height = 1;
    const std::array<double, 3> rgb{0.8, 0.3, 0.1};
    for (const double value : rgb)
        scene.images[0].rgb.push_back(static_cast<float>(value));
    Texture picture;
    picture.type = TextureType::Image;
    picture.space = TextureSpace::Uv;
    picture.size = 1.0;
    picture.image = 0;
    scene.textures = {picture};
    for (const double sigma : {0.0, 0.4}) {
        scene.materials[0].substrate.sigma = sigma;
        scene.materials[0].substrate.type =
            sigma > 0.0 ? SubstrateType::OrenNayar : SubstrateType::Lambert;
        Scene plain = scene; // one colour everywhere: a plain reflectance
        Spectrum coloured;
        for (std::size_t c = 0; c < 3; ++c)
            coloured += rgb_basis()[c].scaled(0.9 * rgb[c]);
        plain.materials[0].substrate.reflectance = coloured;
        plain.materials[0].substrate.reflectance_image = -1;
        const RenderResult found = rendered(scene, 4), wanted = rendered(plain, 4);
        for (int band = 0; band < bands.count; ++band) {
            const double expected = band_statistics(wanted.image, band).mean;
            EXPECT_NEAR(band_statistics(found.image, band).mean, expected, 1e-5 * expected)
                << sigma << ", band " << band;
        }
    }
}

TEST(Textures, ConcentrationOfAFluorophoreFollowsATexture) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / "reradiant_textured_fluorophore.toml";
    std::ofstream(file) << R"(
film = { width = 8, height = 8 }
camera = { origin = [0, 10, 0], target = [0, 0, 0], up = [0, 0, 1], fov_deg = 11.42118627 }
[integrator]
max_depth = 1
[[light]]
type = "directional"
direction = [0, -1, 0]
irradiance = { line_nm = 450, width_nm = 10, scale = 1 }
[[texture]]
name = "squares"
type = "checker"
size = 0.5
[[shape]]
type = "rectangle"
center = [0, 0, 0]
edge_u = [0, 0, 2]
edge_v = [2, 0, 0]
material = "dyed"
[[material]]
name = "dyed"
[material.substrate]
type = "lambert"
[[material.substrate.reradiation.fluorophores]]
excitation = { texture = "squares", low = 0.2, high = 0.6 }
emission = { gaussian_nm = 560, sigma_nm = 20 }
quantum_yield = 0.8
)";
    RenderOptions options;
    options.samples = 8;
    options.bands = grid_from_range(550, 570, 10);
    options.all_features = true;
    const RenderResult result = render(load_scene(file), device(), options);
    std::filesystem::remove(file);
    const auto emitted = [&](int x, int y) { return reflectance_at(result, x, y, 1); };
    // pixel 0, 0 is at x = 7/8, z = 7/8: square 1 + 1; its neighbour two pixels on at x = 3/8
    const double low = emitted(0, 0), high = emitted(2, 0);
    EXPECT_GT(low, 0.0);
    EXPECT_NEAR(high, 3.0 * low, 1e-4 * high);
}

} // namespace
} // namespace reradiant
