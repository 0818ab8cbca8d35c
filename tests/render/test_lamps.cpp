#include "host/scene/lights/sky_light.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

using namespace test;
using std::numbers::pi;

const WavelengthGrid bands = grid_from_range(450, 650, 100);

RenderResult rendered(const Scene& scene, std::uint32_t samples = 64) {
    RenderOptions options;
    options.bands = bands;
    options.samples = samples;
    options.wavelengths.centred = true;
    options.all_features = true; // one program for all of these tests
    return render(scene, device(), options);
}

/// The irradiance that a lamp gives the origin on the level plane, which a narrow camera sees from
/// the side.
BandStatistics irradiance(const Light& lamp, std::uint32_t samples = 64) {
    Scene scene = plane_scene(material({}, 0.5), 80.0, 16, 16);
    scene.lights = {lamp};
    scene.integrator.max_depth = 1;
    BandStatistics found = band_statistics(rendered(scene, samples).image, 1);
    found.mean *= pi / 0.5;
    found.standard_error *= pi / 0.5;
    return found;
}

/// `count` comparisons in all are made like this one; single precision is beside the noise.
void expect_mean(const BandStatistics& found, double expected, int count) {
    EXPECT_NEAR(found.mean, expected,
                sidak_bound(count) * found.standard_error + 3e-5 * std::abs(expected));
}

/// A square of side 2 at height 3 that faces down, of triangles of different sizes.
MeshShape square_mesh() {
    MeshShape mesh;
    mesh.positions = {-1, 3, -1, 1, 3, -1, 1, 3, 1, -1, 3, 1, 0.6f, 3, -0.2f};
    mesh.indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    return mesh;
}

RectangleLight square_light() {
    return {{0, 3, 0}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(2.0)};
}

/// What reflects like a mirror meets lamps by chance, and what is diffuse is found by looking.
std::vector<Material> diffuse_glossy_and_smooth() {
    return {material({}, 0.8), material({layer(1.5, 0.05)}, 0.3), material({layer(1.5)}, 0.3)};
}

TEST(Lamps, MeshLightsAsARectangleOfItsShape) {
    for (const Material& m : diffuse_glossy_and_smooth()) {
        Scene scene = plane_scene(m, 20.0, 24, 24, 40.0);
        scene.lights = {square_light()};
        const BandStatistics rectangle = band_statistics(rendered(scene, 128).image, 1);
        scene.lights = {MeshLight{square_mesh(), Spectrum::constant(2.0)}};
        const BandStatistics mesh = band_statistics(rendered(scene, 128).image, 1);
        // The spread over pixels is the picture's own; it only bounds the error from above.
        EXPECT_NEAR(mesh.mean, rectangle.mean, 0.01 * rectangle.mean);
    }
}

TEST(Lamps, MeshFacesWhereItsTrianglesDo) {
    MeshShape up = square_mesh();
    for (std::size_t i = 0; i < up.indices.size(); i += 3)
        std::swap(up.indices[i], up.indices[i + 1]);
    EXPECT_EQ(irradiance(MeshLight{up, Spectrum::constant(2.0)}, 4).mean, 0.0);
}

/// A square of half side a at height h over a point sends L (4 a / r) atan(a / r) with r^2 = a^2 +
/// h^2, divided into quarters (the form factor of a differential element to a rectangle).
TEST(Lamps, MeshHasTheClosedFormIrradiance) {
    const double x = 1.0 / 3.0, root = std::sqrt(1.0 + x * x);
    const double quarter = x / root * std::atan(x / root) / pi; // form factor of one quarter
    const double expected = 2.0 * pi * 4.0 * quarter;
    expect_mean(irradiance(MeshLight{square_mesh(), Spectrum::constant(2.0)}, 256), expected, 2);
    expect_mean(irradiance(square_light(), 256), expected, 2);
}

TEST(Lamps, DiskHasTheClosedFormIrradiance) {
    for (const double height : {0.2, 1.0, 20.0}) {
        const DiskLight disk{{0, height, 0}, {0, -2, 0}, 0.7, Spectrum::constant(3.0)};
        expect_mean(irradiance(disk, 256), pi * 3.0 * 0.49 / (0.49 + height * height), 3);
    }
    const DiskLight away{{0, 1, 0}, {0, 1, 0}, 0.7, Spectrum::constant(3.0)};
    EXPECT_EQ(irradiance(away, 4).mean, 0.0);
}

/// A smooth coat shows the lamp by its mirror image, which only chance meets.
TEST(Lamps, DiskIsSeenInAMirrorAndDirectly) {
    Scene scene = plane_scene(material({layer(1.5)}, 0.0), 0.0, 8, 8);
    scene.camera.origin = {0, 1, 0};
    scene.lights = {DiskLight{{0, 4, 0}, {0, -1, 0}, 1.0, Spectrum::constant(3.0)}};
    // A direction is chosen among the mirror's and others, so that this is a mean of ones and
    // noughts.
    expect_mean(band_statistics(rendered(scene, 256).image, 1), 3.0 * 0.04, 1);
    scene.camera.target = {0, 4, 0};
    scene.camera.up = {0, 0, 1};
    EXPECT_NEAR(band_statistics(rendered(scene, 4).image, 1).mean, 3.0, 1e-5);
}

TEST(Lamps, SpotHasItsIntensityWithinItsConeAndFallsSmoothly) {
    const auto seen = [](double off_axis_deg) {
        const double angle = off_axis_deg * pi / 180.0;
        const SpotLight spot{
            {0, 2, 0}, {std::sin(angle), -std::cos(angle), 0}, 30.0, 10.0, Spectrum::constant(6.0)};
        return irradiance(spot, 4).mean;
    };
    const auto cosine = [](double degrees) { return std::cos(degrees * pi / 180.0); };
    EXPECT_NEAR(seen(0.0), 1.5, 1e-5);
    EXPECT_NEAR(seen(19.5), 1.5, 1e-5);
    const double s = (cosine(26.0) - cosine(30.0)) / (cosine(20.0) - cosine(30.0));
    EXPECT_NEAR(seen(26.0), 1.5 * s * s * (3.0 - 2.0 * s), 1e-4); // single precision of the cosine
    EXPECT_EQ(seen(31.0), 0.0);
    EXPECT_EQ(seen(150.0), 0.0);
}

TEST(Lamps, DistantLightHasItsIrradianceWhateverItsAngle) {
    const Vector3 travel{0, -std::cos(0.5), std::sin(0.5)};
    for (const double angle_deg : {0.0, 0.533, 20.0, 100.0})
        expect_mean(irradiance(DirectionalLight{travel, Spectrum::constant(2.0), angle_deg}, 256),
                    2.0 * std::cos(0.5), 4);
}

/// The sun and the sky behind it share directions: where all is of radiance 1, a white surface is.
TEST(Lamps, FurnaceOfSkyAndDistantLightsIsWhite) {
    const double half = 20.0 * pi / 180.0;
    const Spectrum of_radiance_1 = Spectrum::constant(pi * std::sin(half) * std::sin(half));
    Image white;
    white.width = 16;
    white.height = 8;
    white.rgb.assign(3 * 16 * 8, 1.0f);
    for (const bool is_image : {false, true})
        for (const Material& m : {material({}, 1.0), material({layer(1.5, 0.1)}, 1.0)}) {
            Scene scene = plane_scene(m, 40.0, 16, 16);
            scene.images = {white};
            EnvironmentLight sky{Spectrum::constant(1.0), is_image ? 0 : -1, 0.0, {}};
            scene.lights = {DirectionalLight{{0, -1, 0.3}, of_radiance_1, 40.0},
                            DirectionalLight{{0.4, -1, 0.2}, of_radiance_1, 40.0}, sky};
            scene.integrator.max_depth = 64;
            const BandStatistics found = band_statistics(rendered(scene, 256).image, 1);
            // Tables of the rough stack hold its flux to some 1e-4.
            EXPECT_NEAR(found.mean, 1.0, sidak_bound(4) * found.standard_error + 5e-4);
        }
}

TEST(Lamps, SkyGivesTheIrradianceOfItsModel) {
    ClearSky sky;
    sky.sun_elevation_deg = 35.0;
    const ClearSkyLight light = clear_sky_light(sky);
    const double elevation = 35.0 * pi / 180.0;
    const Vector3 to_sun{0, std::sin(elevation), -std::cos(elevation)};
    Scene scene = plane_scene(material({}, 0.5), 30.0, 16, 16);
    scene.integrator.max_depth = 1;
    scene.images.emplace_back();
    EnvironmentLight blue = blue_sky_light(light, to_sun, scene.images[0]);
    blue.image = 0;
    scene.lights = {sun_light(light, to_sun), blue};
    const RenderResult result = rendered(scene, 512);
    for (int band = 0; band < bands.count; ++band) {
        const auto place = static_cast<std::size_t>(
            std::find(light.nm.begin(), light.nm.end(), bands.centre_nm(band)) - light.nm.begin());
        if (place == light.nm.size())
            continue; // 650 nm is not in the model's table
        double expected = light.direct[place] * std::sin(elevation);
        for (const auto& part : light.diffuse)
            expected += part[place];
        const BandStatistics found = band_statistics(result.image, band);
        // The image is linear between its texels, which blurs the horizon by half a texel.
        EXPECT_NEAR(found.mean * pi / 0.5, expected,
                    sidak_bound(2) * found.standard_error * pi / 0.5 + 2e-3 * expected);
    }
}

TEST(Opacity, LetsItsShareOfRaysAndOfLightThrough) {
    Scene scene = plane_scene(material({}, 0.5), 30.0, 32, 32);
    scene.materials.push_back(material({}, 0.0));
    scene.surfaces = plain_surfaces(scene);
    scene.surfaces[1].opacity = {0.25, 0.25};
    // Over the plane, out of the camera's way: it takes a quarter of the lamp's light.
    scene.shapes.push_back({RectangleShape{{0, 0.5, 0.5}, {0.6, 0, 0}, {0, 0, -0.6}}, 1});
    scene.lights = {DirectionalLight{{0, -1, -1}, Spectrum::constant(std::sqrt(2.0) * pi)}};
    scene.integrator.max_depth = 1;
    scene.camera.origin = {0, 2, -1};
    scene.camera.target = {0, 0, 0};
    const BandStatistics shade = band_statistics(rendered(scene, 64).image, 1);
    expect_mean(shade, 0.5 * 0.75, 2);
    // In the camera's way: a quarter of the picture's samples is dark.
    scene.camera.origin = {0, 2, 2};
    scene.shapes.back().geometry = RectangleShape{{0, 1.9, 1.9}, {0.1, 0, 0}, {0, 0.1, -0.1}};
    scene.lights = {DirectionalLight{{0, -1, 0}, Spectrum::constant(pi)}};
    const BandStatistics seen = band_statistics(rendered(scene, 64).image, 1);
    expect_mean(seen, 0.5 * 0.75, 2);
}

TEST(NestedMixtures, HaveTheMeanOfWhatTheyHold) {
    Scene scene = plane_scene(material({}, 0.1), 30.0, 32, 32);
    scene.materials.push_back(material({}, 0.5));
    scene.materials.push_back(material({}, 0.9));
    scene.surfaces = plain_surfaces(scene);
    scene.surfaces[0].mixed_with = 1;
    scene.surfaces[0].mix_weight = 0.5;
    scene.surfaces[1].mixed_with = 2;
    scene.surfaces[1].mix_weight = 0.4;
    scene.lights = {DirectionalLight{{0, -1, 0}, Spectrum::constant(pi)}};
    scene.integrator.max_depth = 1;
    expect_mean(band_statistics(rendered(scene, 64).image, 1),
                0.5 * 0.1 + 0.5 * (0.6 * 0.5 + 0.4 * 0.9), 1);
}

} // namespace
} // namespace reradiant
