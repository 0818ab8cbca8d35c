#include "host/scene/lights/sky_light.h"
#include "tests/scene/scratch.h"

#include "reradiant/scene_file.h"

#include <cmath>
#include <numbers>
#include <numeric>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

class Lights : public Scratch {
protected:
    /// The small scene with its light written as `text`; the light's table is in line 7, its first
    /// key in line 8.
    std::filesystem::path scene_with(const std::string& text) {
        return write("scene.toml",
                     replaced(SMALL_SCENE, "type = \"environment\"\nradiance = 1", text));
    }
    std::vector<Light> read(const std::string& text) { return load_scene(scene_with(text)).lights; }
    Caught refusal(const std::string& text) {
        return error_of([&] { read(text); });
    }
    std::vector<std::string> warnings(const std::string& text) {
        return warnings_of([&] { read(text); });
    }
};

void expect_vector(const Vector3& found, const Vector3& expected) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(found[axis], expected[axis], 1e-12) << axis;
}

} // namespace

TEST_F(Lights, ARectangleFacesItsTarget) {
    const auto lights = read("type = \"rectangle\"\ncenter = [1, 4, 2]\ntarget = [1, 1, -2]\n"
                             "size = [3, 2]\nradiance = 1");
    const auto& light = std::get<RectangleLight>(lights.at(0));
    expect_vector(light.edge_u, {-3, 0, 0}); // level
    expect_vector(light.edge_v, {0, 1.6, -1.2});
    // straight down, where nothing is level by itself
    const auto down = read("type = \"rectangle\"\ncenter = [0, 4, 0]\ntarget = [0, 0, 0]\n"
                           "size = [3, 2]\nradiance = 1");
    expect_vector(std::get<RectangleLight>(down.at(0)).edge_u, {3, 0, 0});
    expect_vector(std::get<RectangleLight>(down.at(0)).edge_v, {0, 0, 2});
}

TEST_F(Lights, ATargetThatCannotBeFacedIsRefused) {
    const std::string centre = "type = \"rectangle\"\ncenter = [1, 4, 2]\n";
    EXPECT_EQ(refusal(centre + "target = [1, 4, 2]\nsize = [1, 1]\nradiance = 1").line, 10);
    EXPECT_EQ(refusal(centre + "target = [0, 0, 0]\nedge_u = [1, 0, 0]\nradiance = 1").line, 11);
    EXPECT_EQ(refusal(centre + "target = [0, 0, 0]\nsize = [1, 0]\nradiance = 1").line, 11);
    EXPECT_EQ(refusal(centre + "size = [1, 1]\nradiance = 1").line, 10);
}

TEST_F(Lights, SpotsDisksAndDistantLightsHoldTheirKeys) {
    const auto spot = std::get<SpotLight>(
        read("type = \"spot\"\nposition = [0, 3, 0]\ntarget = [0, 1, 0]\ncone_deg = 20\n"
             "falloff_deg = 8\nintensity = 2")
            .at(0));
    expect_vector(spot.direction, {0, -2, 0});
    EXPECT_EQ(spot.cone_deg, 20.0);
    EXPECT_EQ(spot.falloff_deg, 8.0);
    EXPECT_EQ(spot.intensity(500.0), 2.0);
    const auto narrow = std::get<SpotLight>(
        read("type = \"spot\"\nposition = [0, 3, 0]\ndirection = [0, -1, 0]\ncone_deg = 2\n"
             "intensity = 2")
            .at(0));
    EXPECT_EQ(narrow.falloff_deg, 2.0); // no wider than the cone
    const auto disk = std::get<DiskLight>(
        read("type = \"disk\"\ncenter = [0, 3, 0]\nnormal = [0, -1, 0]\nradius = 0.5\nradiance = 2")
            .at(0));
    EXPECT_EQ(disk.radius, 0.5);
    const auto sun = std::get<DirectionalLight>(
        read("type = \"directional\"\ndirection = [0, -1, 0]\nangle_deg = 0.5\nirradiance = 2")
            .at(0));
    EXPECT_EQ(sun.angle_deg, 0.5);
}

TEST_F(Lights, BadKeysAreRefusedAtTheirPlace) {
    const std::string spot = "type = \"spot\"\nposition = [0, 3, 0]\n";
    EXPECT_EQ(refusal(spot + "target = [0, 0, 0]\ndirection = [0, -1, 0]\nintensity = 1").line, 10);
    EXPECT_EQ(refusal(spot + "direction = [0, 0, 0]\nintensity = 1").line, 10);
    EXPECT_EQ(refusal(spot + "target = [0, 0, 0]\ncone_deg = 181\nintensity = 1").line, 11);
    EXPECT_EQ(
        refusal(spot + "target = [0, 0, 0]\ncone_deg = 10\nfalloff_deg = 11\nintensity = 1").line,
        12);
    EXPECT_EQ(refusal("type = \"directional\"\ndirection = [0, -1, 0]\nangle_deg = 180\n"
                      "irradiance = 1")
                  .line,
              10);
}

TEST_F(Lights, AMeshLightIsMovedAndNeedsAnArea) {
    write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto mesh = std::get<MeshLight>(
        read("type = \"mesh\"\nfile = \"one.obj\"\nscale = [2, 3, 1]\nrotate_deg = [90, 0, 0]\n"
             "translate = [1, 1, 1]\nradiance = 2")
            .at(0));
    EXPECT_FLOAT_EQ(mesh.mesh.positions.at(3), 3.0f);
    EXPECT_FLOAT_EQ(mesh.mesh.positions.at(8), 4.0f); // y became z
    const Caught flat = refusal("type = \"mesh\"\nfile = \"flat.obj\"\nradiance = 2");
    EXPECT_EQ(flat.line, 9);
    EXPECT_NE(flat.text.find("no area"), std::string::npos) << flat.text;
}

TEST_F(Lights, ThatLightNothingAreWarnedAboutAtTheirPlace) {
    const auto expect_warning = [&](const std::string& text, const std::string& reason) {
        const auto found = warnings(text);
        ASSERT_EQ(found.size(), 1u) << text;
        EXPECT_NE(found[0].find("scene.toml:7:"), std::string::npos) << found[0];
        EXPECT_NE(found[0].find(reason), std::string::npos) << found[0];
    };
    expect_warning("type = \"environment\"\nradiance = 0", "black");
    expect_warning("type = \"sphere\"\ncenter = [0, 4, 0]\nradius = 1\n"
                   "radiance = { line_nm = 254, scale = 1 }",
                   "light of 253 to 255 nm lies outside the film's 380 to 780 nm");
    expect_warning("type = \"disk\"\ncenter = [0, 4, 0]\nnormal = [0, 1, 0]\nradius = 1\n"
                   "radiance = 1",
                   "faces away");
    expect_warning("type = \"spot\"\nposition = [0, 4, 0]\ndirection = [1, 0, 0]\nintensity = 1",
                   "faces away");
    // the camera at (0, 0, 5) sees this one, and the sphere's rim is lit by the next
    EXPECT_TRUE(warnings("type = \"disk\"\ncenter = [0, 0, 2]\nnormal = [0, 0, 1]\nradius = 1\n"
                         "radiance = 1")
                    .empty());
    EXPECT_TRUE(warnings("type = \"disk\"\ncenter = [0, 0.9, 0]\nnormal = [0, 1, 0]\nradius = 1\n"
                         "radiance = 1")
                    .empty());
}

/// Ultraviolet light is no idle lamp where something in the scene fluoresces under it.
TEST_F(Lights, OfUltravioletAreNotIdleWhereTheyExcite) {
    const std::string fluorescent =
        replaced(replaced(SMALL_SCENE, "type = \"environment\"\nradiance = 1",
                          "type = \"environment\"\nradiance = { line_nm = 254, scale = 1 }"),
                 "reflectance = 0.5",
                 "reradiation = { fluorophores = [{ excitation = { gaussian_nm = 255, "
                 "sigma_nm = 5, scale = 0.9 }, emission = { gaussian_nm = 500, "
                 "sigma_nm = 20 } }] }");
    const auto file = write("scene.toml", fluorescent);
    for (const std::string& warning : warnings_of([&] { load_scene(file); }))
        EXPECT_EQ(warning.find("lights nothing"), std::string::npos) << warning;
}

/// Values of pvlib 0.16.1's implementation of the same model (spectrl2, with its own inputs set to
/// those here and its correction for the distance of the sun divided out).
TEST(ClearSkies, HaveTheIrradianceOfBirdAndRiordan) {
    struct Value {
        double nm, direct, diffuse;
    };
    const auto compare = [](const ClearSky& sky, const std::vector<Value>& values) {
        const ClearSkyLight light = clear_sky_light(sky);
        for (const Value& value : values) {
            const auto place = static_cast<std::size_t>(
                std::find(light.nm.begin(), light.nm.end(), value.nm) - light.nm.begin());
            ASSERT_LT(place, light.nm.size());
            double diffuse = 0.0;
            for (const auto& part : light.diffuse)
                diffuse += part[place];
            EXPECT_NEAR(light.direct[place], value.direct, 2e-8 * value.direct) << value.nm;
            EXPECT_NEAR(diffuse, value.diffuse, 2e-8 * value.diffuse) << value.nm;
        }
    };
    compare({.sun_elevation_deg = 60.0, .aerosol_depth = 0.1, .ground_albedo = 0.2},
            {{300, 0.00200606529, 0.00287937057},
             {320, 0.146980831, 0.140515225},
             {400, 0.837315463, 0.312063798},
             {550, 1.47256398, 0.219254733},
             {780, 1.07339921, 0.0733041294},
             {937, 0.364034663, 0.0168107357}});
    compare({.sun_elevation_deg = 15.0, .aerosol_depth = 0.27, .ground_albedo = 0.0},
            {{300, 2.42932757e-09, 1.39472893e-07},
             {350, 0.0182092073, 0.0879930811},
             {450, 0.266659095, 0.195906586},
             {656, 0.549053731, 0.116970592}});
}

TEST(ClearSkies, TurbidityIsThatOfPreetham) {
    // beta of 0.0924 at 1 um for T = 3, seen at 0.5 um with alpha = 1.3
    EXPECT_NEAR(aerosol_depth_of_turbidity(3.0), 0.09238 * std::pow(2.0, 1.3), 1e-12);
}

TEST_F(Lights, ASkyIsASunAndAnImageOfThreeParts) {
    const auto lights = read("type = \"sky\"\nsun_elevation_deg = 30\nsun_azimuth_deg = 90\n"
                             "scale = 2");
    ASSERT_EQ(lights.size(), 2u);
    const auto& sun = std::get<DirectionalLight>(lights[1]);
    expect_vector(sun.direction, {-std::sqrt(0.75), -0.5, 0});
    EXPECT_NEAR(sun.angle_deg, 0.533, 1e-12);
    const auto& sky = std::get<EnvironmentLight>(lights[0]);
    EXPECT_EQ(sky.primaries.size(), 3u);
    EXPECT_EQ(sky.radiance(290.0), 0.0); // ozone leaves nothing below 300 nm
    EXPECT_GT(sky.radiance(320.0), 0.1);
    ClearSky model;
    model.sun_elevation_deg = 30.0;
    const ClearSkyLight light = clear_sky_light(model);
    EXPECT_NEAR(sun.irradiance(light.nm[30]), 2.0 * light.direct[30], 1e-12);
    EXPECT_EQ(read("type = \"sky\"\nsun_elevation_deg = 30\nsun = false").size(), 1u);
    // the sun follows after the lights of all tables, so that these keep their places
    const auto more = read("type = \"sky\"\nsun_elevation_deg = 30\n[[light]]\ntype = \"point\"\n"
                           "position = [0, 3, 0]\nintensity = 1");
    ASSERT_EQ(more.size(), 3u);
    EXPECT_TRUE(std::holds_alternative<PointLight>(more[1]));
    EXPECT_TRUE(std::holds_alternative<DirectionalLight>(more[2]));
}

TEST_F(Lights, ASkyRefusesWhatItIsNot) {
    EXPECT_EQ(refusal("type = \"sky\"\nsun_elevation_deg = 0").line, 9);
    EXPECT_EQ(refusal("type = \"sky\"\nsun_elevation_deg = 10\nground_albedo = 1").line, 10);
    EXPECT_EQ(refusal("type = \"sky\"\nsun_elevation_deg = 10\nturbidity = 11").line, 10);
    EXPECT_EQ(
        refusal("type = \"sky\"\nsun_elevation_deg = 10\nturbidity = 3\naerosol_depth = 1").line,
        11);
    EXPECT_EQ(refusal("type = \"sky\"").line, 7);
}
