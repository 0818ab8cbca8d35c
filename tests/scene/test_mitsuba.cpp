#include "tests/scene/scratch.h"

#include "host/scene/mitsuba_import.h"
#include "host/spectral/colour.h"

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

using testing::Caught;
using testing::error_of;
using testing::warnings_of;

/// Lines 1 to 5: a sensor; what a test adds begins at line 6.
const std::string head = R"(<scene version="3.0.0">
<sensor type="perspective"><float name="fov" value="40"/>
<transform name="to_world"><lookat origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="4"/></film>
</sensor>
)";

class Mitsuba : public testing::Scratch {
protected:
    Scene load(const std::string& body) {
        return load_scene(write("scene.xml", head + body + "\n</scene>\n"));
    }
    Caught refusal(const std::string& body) {
        return error_of([&] { load(body); });
    }
    /// The material of a sphere with this bsdf.
    Material material(const std::string& bsdf) {
        return load("<shape type=\"sphere\">" + bsdf + "</shape>").materials.at(0);
    }
};

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

TEST_F(Mitsuba, StepsOfATransformAreAppliedInTheirOrder) {
    const Scene scene = load(R"(<shape type="sphere"><float name="radius" value="2"/>
<transform name="to_world"><translate x="1"/><scale value="3"/><rotate y="1" angle="90"/></transform>
</shape>)");
    const auto& sphere = std::get<SphereShape>(scene.shapes.at(0).geometry);
    EXPECT_NEAR(sphere.center[0], 0.0, 1e-12);
    EXPECT_NEAR(sphere.center[2], -3.0, 1e-12); // +x turned about +y by 90 degrees is -z
    EXPECT_NEAR(sphere.radius, 6.0, 1e-12);
}

TEST_F(Mitsuba, RectanglesEmitTheWayTheyFace) {
    for (const char* flip : {"false", "true"}) {
        const Scene scene = load(std::string(R"(<shape type="rectangle">
<transform name="to_world"><scale x="2" y="3"/><rotate x="1" angle="90"/></transform>
<boolean name="flip_normals" value=")") +
                                 flip + R"("/>
<emitter type="area"><spectrum name="radiance" value="2"/></emitter></shape>)");
        const auto& light = std::get<RectangleLight>(scene.lights.at(0));
        const Vector3 &u = light.edge_u, &v = light.edge_v;
        // faces +z, which the rotation turns to -y
        const double y = u[2] * v[0] - u[0] * v[2];
        EXPECT_NEAR(std::abs(y), 24.0, 1e-12);
        EXPECT_EQ(y < 0.0, std::string(flip) == "false");
        EXPECT_DOUBLE_EQ(light.radiance(500.0), 2.0);
        EXPECT_TRUE(scene.shapes.empty());
    }
}

TEST_F(Mitsuba, Disk) {
    const Scene scene = load(R"(<shape type="disk"><transform name="to_world">
<scale value="2"/><rotate x="1" angle="-90"/><translate y="1"/></transform></shape>)");
    const auto& disk = std::get<DiskShape>(scene.shapes.at(0).geometry);
    EXPECT_NEAR(disk.radius, 2.0, 1e-12);
    EXPECT_NEAR(disk.normal[1], 1.0, 1e-12);
    EXPECT_NEAR(disk.center[1], 1.0, 1e-12);
}

TEST_F(Mitsuba, MeshesAreMoved) {
    write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
    const Scene scene = load(R"(<shape type="obj"><string name="filename" value="triangle.obj"/>
<transform name="to_world"><scale x="2"/><rotate x="1" angle="90"/><translate z="4"/></transform>
</shape>)");
    const auto& mesh = std::get<MeshShape>(scene.shapes.at(0).geometry);
    const std::vector<float> expected{0, 0, 4, 2, 0, 4, 0, 0, 5};
    ASSERT_EQ(mesh.positions.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_NEAR(mesh.positions[k], expected[k], 1e-6f);
    EXPECT_NEAR(mesh.normals.at(1), -1.0f, 1e-6f);
}

TEST_F(Mitsuba, CubesAreSixRectanglesThatFaceOutwards) {
    const Scene scene = load(R"(<shape type="cube"><transform name="to_world">
<scale x="2"/><translate y="1"/></transform></shape>)");
    ASSERT_EQ(scene.shapes.size(), 6u);
    for (const Shape& shape : scene.shapes) {
        const auto& face = std::get<RectangleShape>(shape.geometry);
        const Vector3 &u = face.edge_u, &v = face.edge_v;
        const double outwards = (u[1] * v[2] - u[2] * v[1]) * face.center[0] +
                                (u[2] * v[0] - u[0] * v[2]) * (face.center[1] - 1.0) +
                                (u[0] * v[1] - u[1] * v[0]) * face.center[2];
        EXPECT_NEAR(outwards, 16.0 / 2.0,
                    1e-12); // distance times area, a sixth of thrice the volume
    }
}

TEST_F(Mitsuba, MeshOfOneParallelogramEmits) {
    write("lamp.obj", "v 0 0 0\nv 2 0 0\nv 2 0 1\nv 0 0 1\nf 1 2 3 4\n");
    write("kite.obj", "v 0 0 0\nv 2 0 0\nv 3 0 1\nv 0 0 1\nf 1 2 3 4\n");
    const std::string shape = R"(<shape type="obj"><string name="filename" value="NAME"/>
<transform name="to_world"><translate y="5"/></transform><ref id="lamp"/></shape>
<emitter type="area" id="lamp"/>)";
    const Scene scene = load(testing::replaced(shape, "NAME", "lamp.obj"));
    const auto& light = std::get<RectangleLight>(scene.lights.at(0));
    EXPECT_EQ(light.center, (Vector3{1, 5, 0.5}));
    EXPECT_EQ(light.edge_u, (Vector3{2, 0, 0}));
    EXPECT_EQ(light.edge_v, (Vector3{0, 0, 1}));
    EXPECT_NE(refusal(testing::replaced(shape, "NAME", "kite.obj")).text.find("parallelogram"),
              std::string::npos);
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

TEST_F(Mitsuba, ImagesBeginWithTheirTopRow) {
    // Mitsuba 3.9.1 shows an image upside down on a rectangle, and upright on an OBJ mesh.
    std::filesystem::copy_file(std::filesystem::path(RERADIANT_SOURCE_DIR) /
                                   "tools/examples/presets.png",
                               folder / "image.png");
    write("quad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 0.75\nf 1/1 2/2 3/3\n");
    const auto with = [&](const std::string& shape, const std::string& texture) {
        return load(R"(<bsdf type="diffuse" id="a"><texture name="reflectance" )" + texture +
                    "</texture></bsdf><shape type=" + shape + "<ref id=\"a\"/></shape>");
    };
    const std::string image = R"(type="bitmap"><string name="filename" value="image.png"/>)",
                      squares = R"(type="checkerboard">)",
                      mesh = R"("obj"><string name="filename" value="quad.obj"/>)";
    const auto edge = [](const Scene& scene) {
        return std::get<RectangleShape>(scene.shapes.at(0).geometry).edge_v[1];
    };
    EXPECT_DOUBLE_EQ(edge(with("\"rectangle\">", image)), -2.0);
    EXPECT_DOUBLE_EQ(edge(with("\"rectangle\">", squares)), 2.0);
    const auto v = [](const Scene& scene) {
        return std::get<MeshShape>(scene.shapes.at(0).geometry).texture_coordinates.at(5);
    };
    EXPECT_FLOAT_EQ(v(with(mesh, image)), 0.75f);
    EXPECT_FLOAT_EQ(v(with(mesh, squares)), 0.25f);
    EXPECT_NE(error_of([&] { with("\"sphere\">", image); }).text.find("a texture on a sphere"),
              std::string::npos);
}

TEST_F(Mitsuba, PathDepthIsCountedFromTheLight) {
    EXPECT_EQ(load(R"(<integrator type="path"><integer name="max_depth" value="5"/></integrator>)")
                  .integrator.max_depth,
              4);
    EXPECT_EQ(load(R"(<integrator type="direct"/>)").integrator.max_depth, 1);
}

TEST_F(Mitsuba, WhatIsNotSupportedIsNamedWithItsPlace) {
    const auto expect = [&](const std::string& body, const std::string& text, int line,
                            int column) {
        const Caught caught = refusal(body);
        ASSERT_TRUE(caught.thrown) << body;
        EXPECT_EQ(caught.exit_code, 2);
        EXPECT_NE(caught.text.find(text), std::string::npos) << caught.text;
        EXPECT_EQ(caught.line, line) << caught.text;
        EXPECT_EQ(caught.column, column) << caught.text;
    };
    expect("<shape type=\"cylinder\"/>", "shape \"cylinder\"", 6, 1);
    expect("<shape type=\"sphere\">\n  <bsdf type=\"dielectric\"/></shape>", "bsdf \"dielectric\"",
           7, 3);
    expect("<shape type=\"sphere\"><float name=\"radios\" value=\"1\"/></shape>", "radios", 6, 22);
    expect("<medium type=\"homogeneous\"/>", "<medium>", 6, 1);
    expect("<include filename=\"other.xml\"/>", "<include>", 6, 1);
    expect("<shape type=\"sphere\"><ref id=\"none\"/></shape>", "\"none\"", 6, 22);
    expect("<emitter type=\"spot\"/>", "emitter \"spot\"", 6, 1);
    expect("<emitter type=\"envmap\"><string name=\"filename\" value=\"no.exr\"/></emitter>",
           "no.exr", 6, 24);
    expect("<shape type=\"disk\"><emitter type=\"area\"/></shape>", "disk that emits", 6, 1);
    expect(
        "<shape type=\"sphere\"><transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
        "stretches", 6, 1);
    expect(
        "<shape type=\"sphere\"><transform name=\"to_world\"><shear x=\"2\"/></transform></shape>",
        "<shear>", 6, 49);
    expect("<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>", "$r", 6, 22);
    expect("<shape type=\"sphere\"><float name=\"radius\" value=\"1x\"/></shape>", "1x", 6, 22);
    expect("<bsdf type=\"plastic\"><string name=\"int_ior\" value=\"butter\"/></bsdf>", "butter", 6,
           22);
    expect("<bsdf type=\"roughconductor\"><float name=\"alpha_u\" value=\"1\"/></bsdf>",
           "anisotropic", 6, 29);
    expect("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"400:1 300:1\"/></bsdf>",
           "ascending", 6, 22);
    expect("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>", "twice", 6, 30);
    expect("<shape type=\"sphere\">", "not valid XML", 7, 3);
}

TEST_F(Mitsuba, WhatChangesLittleIsLeftOutWithAWarning) {
    const auto warned = warnings_of([&] {
        load(R"(<shape type="rectangle"><bsdf type="diffuse"/><emitter type="area"/></shape>
<bsdf type="plastic"/>)");
    });
    ASSERT_EQ(warned.size(), 2u);
    EXPECT_NE(warned[0].find("scene.xml:6:25"), std::string::npos) << warned[0];
    EXPECT_NE(warned[1].find("nonlinear"), std::string::npos) << warned[1];
}

TEST_F(Mitsuba, Case36HostileFiles) {
    const std::string text = head + "<shape type=\"sphere\"/></scene>";
    for (std::size_t length = 0; length < text.size() - 1; ++length)
        EXPECT_TRUE(error_of([&] { load_scene(write("cut.xml", text.substr(0, length))); }).thrown)
            << length;
    std::string deep = head;
    for (int k = 0; k < 100000; ++k)
        deep += "<a>";
    EXPECT_TRUE(error_of([&] { load_scene(write("deep.xml", deep)); }).thrown);
    std::string nested = head;
    for (int k = 0; k < 1000; ++k)
        nested += "<bsdf type=\"twosided\">";
    for (int k = 0; k < 1000; ++k)
        nested += "</bsdf>";
    EXPECT_TRUE(error_of([&] { load_scene(write("n.xml", nested + "</scene>")); }).thrown);
    const Caught loop = refusal("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>");
    EXPECT_NE(loop.text.find("itself"), std::string::npos) << loop.text;
}

} // namespace
} // namespace reradiant
