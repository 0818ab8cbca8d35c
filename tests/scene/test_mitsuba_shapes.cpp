#include "tests/scene/mitsuba_fixture.h"

#include <cmath>

namespace reradiant {
namespace {

using testing::error_of;

class MitsubaShapes : public testing::MitsubaFixture {};

TEST_F(MitsubaShapes, StepsOfATransformAreAppliedInTheirOrder) {
    const Scene scene = load(R"(<shape type="sphere"><float name="radius" value="2"/>
<transform name="to_world"><translate x="1"/><scale value="3"/><rotate y="1" angle="90"/></transform>
</shape>)");
    const auto& sphere = std::get<SphereShape>(scene.shapes.at(0).geometry);
    EXPECT_NEAR(sphere.centre[0], 0.0, 1e-12);
    EXPECT_NEAR(sphere.centre[2], -3.0, 1e-12); // +x turned about +y by 90 degrees is -z
    EXPECT_NEAR(sphere.radius, 6.0, 1e-12);
}

TEST_F(MitsubaShapes, RectanglesEmitTheWayTheyFace) {
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

TEST_F(MitsubaShapes, DisksAndMeshesEmit) {
    write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Scene scene = load(R"(<shape type="disk"><boolean name="flip_normals" value="true"/>
<emitter type="area"><spectrum name="radiance" value="2"/></emitter></shape>
<shape type="obj"><string name="filename" value="one.obj"/>
<transform name="to_world"><scale value="2"/></transform>
<emitter type="area"><spectrum name="radiance" value="3"/></emitter></shape>)");
    const auto& disk = std::get<DiskLight>(scene.lights.at(0));
    EXPECT_NEAR(disk.normal[2], -1.0, 1e-12);
    EXPECT_NEAR(disk.radius, 1.0, 1e-12);
    const auto& mesh = std::get<MeshLight>(scene.lights.at(1));
    EXPECT_FLOAT_EQ(mesh.mesh.positions.at(3), 2.0f);
    EXPECT_DOUBLE_EQ(mesh.radiance(500.0), 3.0);
}

TEST_F(MitsubaShapes, SpotsLookAlongTheirZ) {
    Scene scene;
    const auto warned = testing::warnings_of([&] {
        scene = load(R"(<emitter type="spot"><float name="cutoff_angle" value="30"/>
<float name="beam_width" value="24"/><spectrum name="intensity" value="5"/>
<transform name="to_world"><lookat origin="0, 3, 0" target="0, 0, 0" up="0, 0, 1"/></transform>
</emitter><shape type="sphere"/>)");
    });
    const auto& spot = std::get<SpotLight>(scene.lights.at(0));
    EXPECT_NEAR(spot.direction[1], -1.0, 1e-12);
    EXPECT_NEAR(spot.position[1], 3.0, 1e-12);
    EXPECT_DOUBLE_EQ(spot.cone_deg, 30.0);
    EXPECT_DOUBLE_EQ(spot.falloff_deg, 6.0);
    ASSERT_EQ(warned.size(), 1u);
    EXPECT_NE(warned[0].find("smoothly"), std::string::npos) << warned[0];
}

TEST_F(MitsubaShapes, Disk) {
    const Scene scene = load(R"(<shape type="disk"><transform name="to_world">
<scale value="2"/><rotate x="1" angle="-90"/><translate y="1"/></transform></shape>)");
    const auto& disk = std::get<DiskShape>(scene.shapes.at(0).geometry);
    EXPECT_NEAR(disk.radius, 2.0, 1e-12);
    EXPECT_NEAR(disk.normal[1], 1.0, 1e-12);
    EXPECT_NEAR(disk.centre[1], 1.0, 1e-12);
}

TEST_F(MitsubaShapes, MeshesAreMoved) {
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

TEST_F(MitsubaShapes, CubesAreSixRectanglesThatFaceOutwards) {
    const Scene scene = load(R"(<shape type="cube"><transform name="to_world">
<scale x="2"/><translate y="1"/></transform></shape>)");
    ASSERT_EQ(scene.shapes.size(), 6u);
    for (const Shape& shape : scene.shapes) {
        const auto& face = std::get<RectangleShape>(shape.geometry);
        const Vector3 &u = face.edge_u, &v = face.edge_v;
        const double outwards = (u[1] * v[2] - u[2] * v[1]) * face.centre[0] +
                                (u[2] * v[0] - u[0] * v[2]) * (face.centre[1] - 1.0) +
                                (u[0] * v[1] - u[1] * v[0]) * face.centre[2];
        EXPECT_NEAR(outwards, 16.0 / 2.0,
                    1e-12); // distance times area, a sixth of thrice the volume
    }
}

TEST_F(MitsubaShapes, MeshOfOneParallelogramEmits) {
    write("lamp.obj", "v 0 0 0\nv 2 0 0\nv 2 0 1\nv 0 0 1\nf 1 2 3 4\n");
    write("kite.obj", "v 0 0 0\nv 2 0 0\nv 3 0 1\nv 0 0 1\nf 1 2 3 4\n");
    const std::string shape = R"(<shape type="obj"><string name="filename" value="NAME"/>
<transform name="to_world"><translate y="5"/></transform><ref id="lamp"/></shape>
<emitter type="area" id="lamp"/>)";
    const Scene scene = load(testing::replaced(shape, "NAME", "lamp.obj"));
    const auto& light = std::get<RectangleLight>(scene.lights.at(0));
    EXPECT_EQ(light.centre, (Vector3{1, 5, 0.5}));
    EXPECT_EQ(light.edge_u, (Vector3{2, 0, 0}));
    EXPECT_EQ(light.edge_v, (Vector3{0, 0, 1}));
    const Scene kite = load(testing::replaced(shape, "NAME", "kite.obj"));
    EXPECT_EQ(std::get<MeshLight>(kite.lights.at(0)).mesh.indices.size(), 6u);
}

TEST_F(MitsubaShapes, MeshesWithoutNormalsAreSmooth) {
    // The normals that Mitsuba 3.9.1 shows for this mesh (mitsuba.traverse)
    write("bent.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0.5\nv -1 1 1\nf 1 2 3\nf 1 3 4\n");
    const std::string shape = R"(<shape type="obj"><string name="filename" value="bent.obj"/>)";
    const auto normals = [&](const std::string& more) {
        return std::get<MeshShape>(load(shape + more + "</shape>").shapes.at(0).geometry).normals;
    };
    const std::vector<float> found = normals("");
    const std::vector<float> expected{0.11000389f,  -0.34320322f, 0.93279725f,  0.0f,
                                      -0.24253564f, 0.97014254f,  0.11807136f,  -0.35035744f,
                                      0.9291442f,   0.21821788f,  -0.43643576f, 0.8728715f};
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], 1e-6f);
    EXPECT_TRUE(normals(R"(<boolean name="face_normals" value="true"/>)").empty());
    // Computed of the moved mesh: flattened, it faces +z.
    const auto flat = normals(R"(<transform name="to_world"><scale z="1e-6"/></transform>)");
    EXPECT_NEAR(flat.at(2), 1.0f, 1e-6f);
}

TEST_F(MitsubaShapes, ImagesBeginWithTheirTopRow) {
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

} // namespace
} // namespace reradiant
