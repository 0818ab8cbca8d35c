#include "tests/scene/mitsuba_fixture.h"

#include "reradiant/colour.h"
#include "reradiant/scene_file.h"

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

using testing::Caught;
using testing::error_of;
using testing::mitsuba_head;
using testing::warnings_of;

class Mitsuba : public testing::MitsubaFixture {};

TEST_F(Mitsuba, SensorAndFilm) {
    const Scene scene = load("");
    EXPECT_EQ(scene.film.width, 8);
    EXPECT_EQ(scene.film.height, 4);
    EXPECT_EQ(scene.camera.origin, (Vector3{0, 1, 5}));
    EXPECT_DOUBLE_EQ(scene.camera.target[2], 4.0);
    // 40 degrees along the width of 8, so that tan(fov / 2) along the height of 4 is half of it
    const double expected = std::atan(std::tan(20.0 * std::numbers::pi / 180.0) * 0.5);
    EXPECT_NEAR(scene.camera.fov_deg, 2.0 * expected * 180.0 / std::numbers::pi, 1e-12);
}

TEST_F(Mitsuba, WithoutAFovTheFocalLengthCounts) {
    const auto fov_deg = [&](const std::string& property) {
        const std::string fov = "<float name=\"fov\" value=\"40\"/>";
        return load_scene(
                   write("scene.xml", testing::replaced(mitsuba_head, fov, property) + "</scene>"))
            .camera.fov_deg;
    };
    // x_fov of Mitsuba 3.9.1 at twice the width of the height
    const auto vertical = [](double x_fov_deg) {
        const double half = std::numbers::pi / 360.0;
        return std::atan(0.5 * std::tan(x_fov_deg * half)) / half;
    };
    EXPECT_NEAR(fov_deg(""), vertical(42.31171417), 1e-5);
    for (const char* text : {"12", "12mm"})
        EXPECT_NEAR(fov_deg(std::string("<string name=\"focal_length\" value=\"") + text + "\"/>"),
                    vertical(116.38780212), 1e-5);
    for (const char* text : {"", "mm", "-3mm", "12cm"})
        EXPECT_TRUE(error_of([&] {
                        fov_deg(std::string("<string name=\"focal_length\" value=\"") + text +
                                "\"/>");
                    }).thrown)
            << text;
}

TEST_F(Mitsuba, WhatScenesOfOthersHold) {
    const auto warned = warnings_of([&] {
        load(R"(<integrator type="aov"><string name="aovs" value="depth:depth"/>
<integrator type="path" name="image"/></integrator>
<shape type="sphere"><bsdf type="roughconductor">
<rgb name="specular_reflectance" value="1, 1.0, 1"/></bsdf></shape>
<emitter type="point"><vector name="position" x="4" y="3"/></emitter>)");
    });
    ASSERT_EQ(warned.size(), 1u);
    EXPECT_NE(warned[0].find("aovs"), std::string::npos) << warned[0];
    const std::string offset = "<float name=\"principal_point_offset_x\" value=\"-0\"/>";
    const std::string text = testing::replaced(mitsuba_head, "<film", offset + "<film");
    EXPECT_NO_THROW(load_scene(write("s.xml", text + "</scene>")));
    EXPECT_TRUE(error_of([&] {
                    load_scene(write("s.xml", testing::replaced(text, "-0", "0.1") + "</scene>"));
                }).thrown);
}

TEST_F(Mitsuba, EmissionInAllItsForms) {
    write("lamp.spd", "400 1\n700 3\n");
    const auto radiance = [&](const std::string& property) {
        const Scene scene = load("<emitter type=\"constant\">" + property + "</emitter>");
        return std::get<EnvironmentLight>(scene.lights.at(0)).radiance;
    };
    EXPECT_DOUBLE_EQ(radiance("<spectrum name=\"radiance\" value=\"3\"/>")(555.0), 3.0);
    EXPECT_NEAR(radiance("<spectrum name=\"radiance\" value=\"400:1, 600:2\"/>")(500.0), 1.5,
                1e-12);
    EXPECT_NEAR(radiance("<spectrum name=\"radiance\" filename=\"lamp.spd\"/>")(550.0), 2.0, 1e-12);
    EXPECT_NEAR(xyz_of(radiance(""))[1], 1.0, 1e-9); // D65
    EXPECT_NEAR(xyz_of(radiance("<float name=\"radiance\" value=\"4\"/>"))[1], 4.0, 1e-9);
    EXPECT_NEAR(xyz_of(radiance("<rgb name=\"radiance\" value=\"2, 2, 2\"/>"))[1], 2.0, 1e-9);
    const Xyz coloured = xyz_of(radiance("<rgb name=\"radiance\" value=\"2, 1, 0.5\"/>"));
    // linear sRGB of IEC 61966-2-1; the table has steps of 5 nm
    EXPECT_NEAR(coloured[1], 0.2126 * 2.0 + 0.7152 + 0.0722 * 0.5, 2e-3);
    const auto type = [&](const std::string& name, const std::string& properties) {
        return radiance("<spectrum name=\"radiance\" type=\"" + name + "\">" + properties +
                        "</spectrum>");
    };
    EXPECT_DOUBLE_EQ(type("uniform", "<float name=\"value\" value=\"2\"/>")(500.0), 2.0);
    EXPECT_NEAR(xyz_of(type("d65", "<float name=\"scale\" value=\"2\"/>"))[1], 2.0, 1e-9);
    EXPECT_NEAR(type("regular", R"(<float name="wavelength_min" value="400"/>
<float name="wavelength_max" value="600"/><string name="values" value="1, 3"/>)")(500.0),
                2.0, 1e-12);
    EXPECT_NEAR(type("irregular", R"(<string name="wavelengths" value="400, 500, 600"/>
<string name="values" value="1, 3, 1"/>)")(450.0),
                2.0, 1e-12);
    // Mitsuba 3.9.1 renders a sky of this as Y = 12594, at 4096 samples of a pixel
    EXPECT_NEAR(xyz_of(type("blackbody", "<float name=\"temperature\" value=\"5000\"/>"))[1], 12594,
                100);
}

TEST_F(Mitsuba, SampledSpectraAreZeroBeyondTheirSamples) {
    // Mitsuba 3.9.1: a sky of 400:0.1 ... 700:0.8 has radiance 0 from 700 nm on.
    write("paint.spd", "400 0.5\n600 0.75\n");
    const auto reflectance = [&](const std::string& spectrum) {
        return material("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" " + spectrum +
                        "</bsdf>")
            .substrate.reflectance;
    };
    for (const char* form :
         {R"(value="400:0.5, 600:0.75"/>)", R"(filename="paint.spd"/>)",
          R"(type="irregular"><string name="wavelengths" value="400, 600"/><string name="values"
value="0.5, 0.75"/></spectrum>)",
          R"(type="regular"><float name="wavelength_min" value="400"/><float name="wavelength_max"
value="600"/><string name="values" value="0.5, 0.75"/></spectrum>)"}) {
        const Spectrum found = reflectance(form);
        EXPECT_DOUBLE_EQ(found(399.9), 0.0);
        EXPECT_DOUBLE_EQ(found(400.0), 0.5);
        EXPECT_DOUBLE_EQ(found(600.0), 0.75);
        EXPECT_DOUBLE_EQ(found(600.1), 0.0);
        EXPECT_DOUBLE_EQ(found(830.0), 0.0);
    }
    EXPECT_DOUBLE_EQ(reflectance(R"(value="300:0.5, 830:0.75"/>)")(850.0), 0.75);
    const Material metal = material(R"(<bsdf type="conductor"><spectrum name="eta"
value="400:0.2, 600:0.4"/><spectrum name="k" value="400:3, 600:4"/></bsdf>)");
    EXPECT_DOUBLE_EQ(metal.substrate.conductor.ior(700.0), 0.4);
}

TEST_F(Mitsuba, Materials) {
    EXPECT_DOUBLE_EQ(material("").substrate.reflectance(500.0), 0.5);
    EXPECT_DOUBLE_EQ(material(R"(<bsdf type="twosided"><bsdf type="diffuse">
<spectrum name="reflectance" value="0.3"/></bsdf></bsdf>)")
                         .substrate.reflectance(500.0),
                     0.3);
    const Material plastic = material(R"(<bsdf type="plastic"><float name="int_ior" value="1.5"/>
<string name="ext_ior" value="vacuum"/><boolean name="nonlinear" value="true"/></bsdf>)");
    ASSERT_EQ(plastic.stack.layers.size(), 1u);
    EXPECT_DOUBLE_EQ(plastic.stack.layers[0].ior(500.0), 1.5);
    EXPECT_EQ(plastic.stack.layers[0].alpha, 0.0);
    const Material rough = material(R"(<bsdf type="roughplastic"><float name="alpha" value="0.2"/>
<string name="distribution" value="ggx"/><boolean name="nonlinear" value="true"/></bsdf>)");
    EXPECT_DOUBLE_EQ(rough.stack.layers.at(0).ior(500.0), 1.49 / 1.000277);
    EXPECT_DOUBLE_EQ(rough.stack.layers[0].alpha, 0.2);
    EXPECT_EQ(rough.stack.layers[0].scattering, Scattering::Single);
    const Material metal =
        material(R"(<bsdf type="roughconductor"><string name="material" value="Au"/></bsdf>)");
    EXPECT_EQ(metal.substrate.type, SubstrateType::Conductor);
    EXPECT_EQ(metal.substrate.conductor.distribution, Distribution::Beckmann);
    EXPECT_DOUBLE_EQ(metal.substrate.conductor.alpha, 0.1);
    const Material coated = material(R"(<bsdf type="coating"><float name="int_ior" value="1.5"/>
<float name="ext_ior" value="1"/><float name="thickness" value="2"/><spectrum name="sigma_a" value="0.1"/>
<bsdf type="conductor"><spectrum name="eta" value="0.2"/><spectrum name="k" value="3"/></bsdf></bsdf>)");
    EXPECT_EQ(coated.substrate.type, SubstrateType::Conductor);
    EXPECT_DOUBLE_EQ(coated.stack.layers.at(0).thickness, 2.0);
    EXPECT_DOUBLE_EQ(coated.stack.layers[0].absorption(500.0), 0.1);
}

TEST_F(Mitsuba, PlasticWithoutNonlinearGetsTheReflectanceThatLooksAlike) {
    // The base of reflectance p sends up p / (1 - r p) by way of every reflection; Mitsuba without
    // nonlinear p / (1 - r). r of n = 1.5 is known in closed form.
    const double r = 0.596346;
    const auto base = [&](const std::string& reflectance) {
        return material(R"(<bsdf type="plastic"><float name="int_ior" value="1.5"/>
<float name="ext_ior" value="1"/>)" +
                        reflectance + "</bsdf>")
            .substrate.reflectance;
    };
    const auto expect = [&](double p, double given) {
        EXPECT_NEAR(p / (1.0 - r * p), given / (1.0 - r), 2e-6);
    };
    expect(base("")(550.0), 0.5);
    expect(base(R"(<spectrum name="diffuse_reflectance" value="1"/>)")(550.0), 1.0);
    const auto sampled = base(R"(<spectrum name="diffuse_reflectance" value="400:0.1, 700:0.7"/>)");
    for (const double nm : {400.0, 505.0, 550.0, 700.0})
        expect(sampled(nm), 0.1 + 0.002 * (nm - 400.0));
    EXPECT_DOUBLE_EQ(sampled(720.0), 0.0);
    expect(base(R"(<rgb name="diffuse_reflectance" value="1, 1, 1"/>)")(600.0), 1.0);
    const std::array<double, 3> brown{0.4, 0.2, 0.1};
    expect(base(R"(<rgb name="diffuse_reflectance" value="0.4, 0.2, 0.1"/>)")(600.0),
           reflectance_from_rgb(brown)(600.0));
}

TEST_F(Mitsuba, ReferencesAndDefaults) {
    const Scene scene = load(R"(<default name="grey" value="0.25"/>
<bsdf type="diffuse" id="wall"><spectrum name="reflectance" value="$grey"/></bsdf>
<shape type="sphere"><ref id="wall"/></shape><shape type="disk"><ref id="wall"/></shape>)");
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].name, "wall");
    EXPECT_DOUBLE_EQ(scene.materials[0].substrate.reflectance(500.0), 0.25);
}

TEST_F(Mitsuba, Checkerboard) {
    const Scene scene = load(R"(<shape type="rectangle"><bsdf type="diffuse">
<texture type="checkerboard" name="reflectance"><spectrum name="color0" value="0.1"/>
<spectrum name="color1" value="0.9"/><transform name="to_uv"><scale value="4"/></transform>
</texture></bsdf></shape>)");
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_DOUBLE_EQ(scene.textures[0].size, 0.125);
    EXPECT_EQ(scene.textures[0].space, TextureSpace::Uv);
}

TEST_F(Mitsuba, PathDepthIsCountedFromTheLight) {
    EXPECT_EQ(load(R"(<integrator type="path"><integer name="max_depth" value="5"/></integrator>)")
                  .integrator.max_depth,
              4);
    EXPECT_EQ(load(R"(<integrator type="direct"/>)").integrator.max_depth, 1);
}

void expect_refusal(const Caught& caught, const std::string& text, int line, int column) {
    ASSERT_TRUE(caught.thrown) << text;
    EXPECT_EQ(caught.exit_code, 2);
    EXPECT_NE(caught.text.find(text), std::string::npos) << caught.text;
    EXPECT_NE(caught.text.find(".xml"), std::string::npos) << caught.text;
    EXPECT_EQ(caught.line, line) << caught.text;
    EXPECT_EQ(caught.column, column) << caught.text;
}

TEST_F(Mitsuba, WhatIsNotSupportedIsNamedWithItsPlace) {
    const auto expect = [&](const std::string& body, const std::string& text, int line,
                            int column) { expect_refusal(refusal(body), text, line, column); };
    expect("<shape type=\"cylinder\"/>", "shape \"cylinder\"", 6, 1);
    expect("<shape type=\"sphere\">\n  <bsdf type=\"dielectric\"/></shape>", "bsdf \"dielectric\"",
           7, 3);
    expect("<shape type=\"sphere\"><float name=\"radios\" value=\"1\"/></shape>", "radios", 6, 22);
    expect("<medium type=\"homogeneous\"/>", "<medium>", 6, 1);
    expect("<include filename=\"other.xml\"/>", "<include>", 6, 1);
    expect("<shape type=\"sphere\"><ref id=\"none\"/></shape>", "\"none\"", 6, 22);
    expect("<emitter type=\"projector\"/>", "emitter \"projector\"", 6, 1);
    expect("<emitter type=\"envmap\"><string name=\"filename\" value=\"no.exr\"/></emitter>",
           "no.exr", 6, 24);
    expect("<shape type=\"sphere\"><boolean name=\"flip_normals\" value=\"true\"/>"
           "<emitter type=\"area\"/></shape>",
           "sphere that emits inwards", 6, 65);
    expect(
        "<shape type=\"sphere\"><transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
        "stretches", 6, 1);
    expect(
        "<shape type=\"sphere\"><transform name=\"to_world\"><shear x=\"2\"/></transform></shape>",
        "<shear>", 6, 49);
    expect("<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>", "$r", 6, 22);
    expect("<shape type=\"sphere\"><float name=\"radius\" value=\"1x\"/></shape>", "1x", 6, 22);
    const auto expect_bsdf = [&](const std::string& bsdf, const std::string& text, int column) {
        expect("<shape type=\"sphere\">\n" + bsdf + "</shape>", text, 7, column);
    };
    expect_bsdf("<bsdf type=\"plastic\"><string name=\"int_ior\" value=\"butter\"/></bsdf>",
                "butter", 22);
    expect_bsdf("<bsdf type=\"roughconductor\"><float name=\"alpha_u\" value=\"1\"/></bsdf>",
                "anisotropic", 29);
    expect_bsdf(
        "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"400:1 300:1\"/></bsdf>",
        "ascending", 22);
    expect("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>", "twice", 6, 30);
    expect("<shape type=\"sphere\">", "not valid XML", 7, 3);
}

TEST_F(Mitsuba, WhatTheSceneReaderRefusesIsPlacedInTheXml) {
    const auto expect = [&](const std::string& body, const std::string& text, int line,
                            int column) { expect_refusal(refusal(body), text, line, column); };
    const auto expect_lamp = [&](const std::string& spectrum, const std::string& text, int column) {
        expect("<emitter type=\"constant\">\n<spectrum name=\"radiance\" " + spectrum +
                   "</emitter>",
               text, 7, column);
    };
    expect_lamp("type=\"irregular\"><string name=\"wavelengths\" value=\"400, 600, 500, 700\"/>"
                "<string name=\"values\" value=\"1, 2, 3, 4\"/></spectrum>",
                "500 nm follows 600 nm", 44);
    expect_lamp("type=\"irregular\"><string name=\"wavelengths\" value=\"400, 400\"/>"
                "<string name=\"values\" value=\"1, 2\"/></spectrum>",
                "400 nm follows 400 nm", 44);
    expect_lamp("type=\"regular\"><float name=\"wavelength_min\" value=\"700\"/><float "
                "name=\"wavelength_max\" value=\"400\"/><string name=\"values\" value=\"1, 2\"/>"
                "</spectrum>",
                "follows 700 nm", 84);
    // The unit is checked on the samples, before zeros from 360 to 830 nm join them.
    expect_lamp("value=\"0.001:1, 0.002:1\"/>", "cannot be in nm", 1);
    expect_lamp("value=\"4000:1, 7000:1\"/>", "cannot be in nm", 1);
    expect_lamp("type=\"irregular\"><string name=\"wavelengths\" value=\"4000, 7000\"/>"
                "<string name=\"values\" value=\"1, 2\"/></spectrum>",
                "from 4000 to 7000 cannot be in nm", 1);
    expect_lamp("type=\"regular\"><float name=\"wavelength_min\" value=\"0.4\"/><float "
                "name=\"wavelength_max\" value=\"0.7\"/><string name=\"values\" value=\"1, 2\"/>"
                "</spectrum>",
                "cannot be in nm", 1);
    expect_lamp("value=\"400:-1, 500:1\"/>", "down to -1", 1);
    expect_lamp("type=\"blackbody\"><float name=\"temperature\" value=\"1\"/></spectrum>",
                "blackbody of 1 K", 1);
    const auto expect_bsdf = [&](const std::string& type, const std::string& property,
                                 const std::string& text) {
        expect("<shape type=\"sphere\"><bsdf type=\"" + type + "\">\n" + property +
                   "</bsdf></shape>",
               text, 7, 1);
    };
    expect_bsdf("diffuse", "<spectrum name=\"reflectance\" value=\"1.5\"/>", "1.5");
    expect_bsdf("diffuse", "<spectrum name=\"reflectance\" value=\"400:0.5, 500:1.5\"/>", "1.5");
    expect_bsdf("roughconductor", "<float name=\"alpha\" value=\"-1\"/>", "alpha is -1");
    expect("<shape type=\"sphere\">\n<float name=\"radius\" value=\"-2\"/></shape>", "radius", 7,
           1);
    expect("<integrator type=\"path\"><integer name=\"max_depth\" value=\"20000\"/></integrator>",
           "max_depth", 6, 1);
    // An rgb whose reflectance is mapped while it is imported.
    EXPECT_EQ(refusal("<shape type=\"sphere\">\n<bsdf type=\"plastic\"><rgb "
                      "name=\"diffuse_reflectance\" value=\"2, 1, 1\"/></bsdf></shape>")
                  .line,
              7);
    // No element says it: at the element that ought to.
    const Caught film = error_of([&] {
        load_scene(
            write("scene.xml",
                  testing::replaced(mitsuba_head, "value=\"8\"", "value=\"0\"") + "</scene>"));
    });
    EXPECT_EQ(film.line, 4) << film.text;
}

TEST_F(Mitsuba, WhatChangesLittleIsLeftOutWithAWarning) {
    const auto warned = warnings_of([&] {
        load(R"(<shape type="rectangle"><bsdf type="diffuse"/><emitter type="area"/></shape>
<shape type="sphere"><bsdf type="plastic"/></shape><shape type="rectangle"><bsdf type="plastic">
<texture type="checkerboard" name="diffuse_reflectance"/></bsdf></shape>
<bsdf type="twosided" id="used"><ref id="inner"/></bsdf><bsdf type="diffuse" id="inner"/>
<shape type="sphere"><ref id="used"/></shape><bsdf type="dielectric" id="glass"/>)");
    });
    ASSERT_EQ(warned.size(), 3u);
    EXPECT_NE(warned[0].find("scene.xml:6:25"), std::string::npos) << warned[0];
    EXPECT_NE(warned[1].find("nonlinear"), std::string::npos) << warned[1];
    EXPECT_NE(warned[2].find("scene.xml:10:"), std::string::npos) << warned[2];
}

TEST_F(Mitsuba, Case36HostileFiles) {
    const std::string text = mitsuba_head + "<shape type=\"sphere\"/></scene>";
    for (std::size_t length = 0; length < text.size() - 1; ++length)
        EXPECT_TRUE(error_of([&] { load_scene(write("cut.xml", text.substr(0, length))); }).thrown)
            << length;
    std::string deep = mitsuba_head;
    for (int k = 0; k < 100000; ++k)
        deep += "<a>";
    EXPECT_TRUE(error_of([&] { load_scene(write("deep.xml", deep)); }).thrown);
    std::string nested = mitsuba_head + "<shape type=\"sphere\">";
    for (int k = 0; k < 1000; ++k)
        nested += "<bsdf type=\"twosided\">";
    for (int k = 0; k < 1000; ++k)
        nested += "</bsdf>";
    EXPECT_TRUE(error_of([&] { load_scene(write("n.xml", nested + "</shape></scene>")); }).thrown);
    const Caught loop = refusal("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf><shape "
                                "type=\"disk\"><ref id=\"a\"/></shape>");
    EXPECT_NE(loop.text.find("itself"), std::string::npos) << loop.text;
}

} // namespace
} // namespace reradiant
