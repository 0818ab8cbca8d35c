#include "host/scene/meshes/mesh_io.h"
#include "tests/scene/scratch.h"

#include <Eigen/Geometry>

using namespace reradiant;
using namespace reradiant::testing;

// Meshes as other programs write them.

namespace {

double area_of(const MeshShape& mesh) {
    const auto corner = [&](std::size_t i) {
        return Eigen::Vector3f::Map(&mesh.positions[3 * std::size_t{mesh.indices[i]}])
            .cast<double>()
            .eval();
    };
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        sum += 0.5 * (corner(i + 1) - corner(i)).cross(corner(i + 2) - corner(i)).norm();
    return sum;
}

const std::string TRIANGLE = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\n";
const std::string MARK = "\xef\xbb\xbf";

std::string with_line_ends(std::string text, const std::string& ends) {
    for (std::size_t at = text.find('\n'); at != std::string::npos;
         at = text.find('\n', at + ends.size()))
        text.replace(at, 1, ends);
    return text;
}

std::string l_shape_ply() {
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "1 -1 0\n1 0 0\n0 0 0\n0 1 0\n-1 1 0\n-1 -1 0\n6 0 1 2 3 4 5\n";
}

std::string wedge_ply(const std::string& faces, const std::string& more = "") {
    return "ply\nformat ascii 1.0\ncomment TextureFile t.png\nelement vertex 4\n"
           "property float x\nproperty float y\nproperty float z\nelement face 2\n"
           "property list uchar int vertex_indices\nproperty list uchar float texcoord\n" +
           more + "end_header\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n" + faces;
}

void expect_same(const MeshShape& mesh, const MeshShape& wanted) {
    EXPECT_EQ(mesh.positions, wanted.positions);
    EXPECT_EQ(mesh.indices, wanted.indices);
    EXPECT_EQ(mesh.normals, wanted.normals);
    EXPECT_EQ(mesh.texture_coordinates, wanted.texture_coordinates);
}

} // namespace

TEST(ForeignObj, Case68MarksAndLineEndsMakeNoDifference) {
    const std::string text = TRIANGLE + "v 9 9 9\nf 1 2 3\n";
    const MeshShape wanted = parse_mesh("a.obj", text);
    EXPECT_EQ(area_of(wanted), 2.0);
    expect_same(parse_mesh("a.obj", MARK + text), wanted);
    expect_same(parse_mesh("a.obj", with_line_ends(text, "\r")), wanted);
    expect_same(parse_mesh("a.obj", with_line_ends(text, "\r\n")), wanted);
    expect_same(parse_mesh("a.obj", MARK + with_line_ends(text, "\f\n") + "\x1a"), wanted);
    const Caught error = error_of([&] { parse_mesh("a.obj", with_line_ends(text, "\r") + "f 9"); });
    EXPECT_EQ(error.line, 6);
    EXPECT_NE(error_of([&] {
                  parse_mesh("a.obj", std::string("\xff\xfev\0 \0", 6));
              }).text.find("UTF-16"),
              std::string::npos);
}

TEST(ForeignObj, Case70ConcaveFacesHaveTheirArea) {
    const MeshShape dart =
        parse_mesh("a.obj", "v -1 -1 0\nv 0 0 0\nv 1 -1 0\nv 0 0.8 0\nf 1 2 3 4\n");
    EXPECT_NEAR(area_of(dart), 0.8, 1e-6);
    const MeshShape star = parse_mesh(
        "a.obj", "v 0.0 1.0 0\nv 0.23511 0.32361 0\nv 0.95106 0.30902 0\nv 0.38042 -0.12361 0\n"
                 "v 0.58779 -0.80902 0\nv 0.0 -0.4 0\nv -0.58779 -0.80902 0\n"
                 "v -0.38042 -0.12361 0\nv -0.95106 0.30902 0\nv -0.23511 0.32361 0\n"
                 "f 1 2 3 4 5 6 7 8 9 10\n");
    // The area is that of the shoelace formula for the coordinates above.
    EXPECT_NEAR(area_of(star), 1.1755734, 1e-6);
    const Caught error =
        error_of([&] { parse_mesh("a.obj", TRIANGLE + "v 3 3 0\nf 1 2 3\nf 1 4 2 3\n"); });
    EXPECT_EQ(error.line, 6);
    EXPECT_NE(error.text.find("face 2 crosses itself"), std::string::npos) << error.text;
}

TEST(ForeignObj, StatementsGoOnAfterABackslash) {
    const MeshShape wanted = parse_mesh("a.obj", TRIANGLE + "f 1 2 3\n");
    expect_same(
        parse_mesh("a.obj", "v -1 \\\n -1 0\nv 1 -1\\\n0\nv 0 1 0\ng a \\\nb\nf 1 \\\n2 \\\r\n 3"),
        wanted);
    // In a comment a backslash means nothing.
    expect_same(parse_mesh("a.obj", "# a path\\\n" + TRIANGLE + "f 1 2 3 # so \\\n"), wanted);
    const Caught error = error_of([&] { parse_mesh("a.obj", TRIANGLE + "f 1 \\\n2 \\\n 9\n"); });
    EXPECT_EQ(error.line, 6);
    EXPECT_EQ(error.column, 2);
}

TEST(ForeignObj, AbsentIndicesAreAbsentHoweverTheyAreWritten) {
    const MeshShape wanted = parse_mesh("a.obj", TRIANGLE + "f 1 2 3\n");
    for (const char* face : {"f 1// 2// 3//", "f 1/ 2/ 3/", "f 1/0/0 2/0/0 3/0/0", "f 1//0 2//0 3"})
        expect_same(parse_mesh("a.obj", TRIANGLE + face), wanted);
    const MeshShape textured =
        parse_mesh("a.obj", TRIANGLE + "vt 0.25\nvt +0.5 0.75\nvt 1 1 0\nf 1/1/ 2/2/ -1/-1/\n");
    EXPECT_EQ(textured.texture_coordinates, (std::vector<float>{0.25f, 0, 0.5f, 0.75f, 1, 1}));
    EXPECT_TRUE(textured.normals.empty());
}

TEST(ForeignObj, WeightsAndColoursOfVerticesAreLeftOut) {
    const MeshShape mesh = parse_mesh(
        "a.obj", "v -1 -1 0 1.0\nv 1 -1 0 0.5 0.25 1\nv 0 1 0 1 0 0 1\np 1\nl 1 2\nf 1 2 3\n");
    expect_same(mesh, parse_mesh("a.obj", TRIANGLE + "f 1 2 3\n"));
    EXPECT_NE(error_of([&] { parse_mesh("a.obj", "v 1 2 3 red\n"); }).text.find("\"red\""),
              std::string::npos);
}

TEST(ForeignObj, SurfacesThatAreNotReadAreRefusedAndUnknownStatementsWarnedAbout) {
    const Caught error = error_of(
        [&] { parse_mesh("a.obj", TRIANGLE + "f 1 2 3\ncstype bspline\nsurf 0 1 0 1 1 2 3\n"); });
    EXPECT_EQ(error.line, 6);
    EXPECT_NE(error.text.find("surf"), std::string::npos);
    const auto warnings =
        warnings_of([&] { parse_mesh("a.obj", TRIANGLE + "vv 1 2 3\nvv 1 2 3\ng a\nf 1 2 3\n"); });
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("a.obj:4:1"), std::string::npos) << warnings[0];
}

TEST(ForeignPly, Case70ConcaveFacesHaveTheirArea) {
    EXPECT_NEAR(area_of(parse_mesh("a.ply", l_shape_ply())), 3.0, 1e-6);
    const Caught error = error_of(
        [&] { parse_mesh("a.ply", replaced(l_shape_ply(), "6 0 1 2 3 4 5", "6 0 3 2 1 4 5")); });
    EXPECT_EQ(error.line, 16);
    EXPECT_NE(error.text.find("face 0 crosses itself"), std::string::npos) << error.text;
}

TEST(ForeignPly, Case68MarksAndLineEndsMakeNoDifference) {
    const std::string text = l_shape_ply();
    const MeshShape wanted = parse_mesh("a.ply", text);
    for (const char* ends : {"\r", "\r\n", "\f\n"})
        expect_same(parse_mesh("a.ply", MARK + with_line_ends(text, ends) + "\x1a"), wanted);
    // The bytes after a header that ends lines by CR alone may look like the LF of CR LF.
    std::string binary =
        with_line_ends("ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\n"
                       "property uchar y\nproperty uchar z\nelement face 1\n"
                       "property list uchar uchar vertex_indices\nend_header\n",
                       "\r");
    binary += std::string("\n\0\0\0\1\0\0\0\1\3\0\1\2", 13);
    EXPECT_EQ(parse_mesh("a.ply", binary).positions,
              (std::vector<float>{10, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST(ForeignPly, WedgesGiveCornersTheirOwnTextureCoordinates) {
    const MeshShape mesh =
        parse_mesh("a.ply", wedge_ply("3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 0.5 0.5 0 1\n"));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 4, 3}));
    EXPECT_EQ(mesh.texture_coordinates, (std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1, 0.5f, 0.5f}));
    EXPECT_EQ(mesh.positions[12], 1.0f); // the fifth is a copy of the third
    EXPECT_EQ(mesh.positions[13], 1.0f);
    const MeshShape partly = parse_mesh("a.ply", wedge_ply("3 0 1 2 0\n3 0 2 3 6 1 1 1 0 0 1\n"));
    EXPECT_EQ(partly.positions.size(), 18u);
    const Caught error = error_of(
        [&] { parse_mesh("a.ply", wedge_ply("3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 4 0 0 1 1\n")); });
    EXPECT_EQ(error.line, 17);
    EXPECT_NE(error.text.find("texcoord"), std::string::npos) << error.text;
}

TEST(ForeignPly, WhatIsLeftOutIsWarnedAbout) {
    const auto several = warnings_of([] {
        parse_mesh("a.ply", wedge_ply("3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 1\n",
                                      "property int texnumber\n"));
    });
    ASSERT_EQ(several.size(), 1u);
    EXPECT_NE(several[0].find("texnumber"), std::string::npos) << several[0];
    const auto more =
        warnings_of([] { parse_mesh("a.ply", l_shape_ply() + "\n 3 0 1 2\n3 1 2 3\n"); });
    ASSERT_EQ(more.size(), 1u);
    EXPECT_NE(more[0].find("a.ply:18:2"), std::string::npos) << more[0];
    EXPECT_NE(error_of([] {
                  parse_mesh("a.ply",
                             replaced(l_shape_ply(), "element face 1", "element tristrips 1"));
              }).text.find("strips"),
              std::string::npos);
}

TEST(ForeignPly, NamesOfTextureCoordinatesAreThoseOfOtherPrograms) {
    for (const auto& [u, v] : {std::pair{"u", "v"},
                               {"s", "t"},
                               {"texture_u", "texture_v"},
                               {"texture_s", "texture_t"}}) {
        const MeshShape mesh = parse_mesh(
            "a.ply", std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                 "property float y\nproperty float z\nproperty float ") +
                         u + "\nproperty float " + v +
                         "\nelement face 1\nproperty list int uint vertex_index\nend_header\n"
                         "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
        EXPECT_EQ(mesh.texture_coordinates, (std::vector<float>{0, 0, 1, 0, 0, 1})) << u;
    }
}
