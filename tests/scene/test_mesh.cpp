#include "host/scene/meshes/mesh_io.h"
#include "tests/scene/scratch.h"

#include <algorithm>
#include <bit>
#include <cstring>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

const char* const HEADER_END = "property float x\nproperty float y\nproperty float z\n"
                               "element face 2\nproperty list uchar int vertex_indices\n"
                               "end_header\n";

std::string ascii_ply() {
    return std::string("ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\n") + HEADER_END +
           "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n4 0 1 2 3\n3 0 1 2\n";
}

template <typename T>
void append(std::string& bytes, T value, bool big_endian) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_endian == (std::endian::native == std::endian::little))
        std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

std::string binary_ply(bool big_endian) {
    std::string bytes = std::string("ply\nformat ") +
                        (big_endian ? "binary_big_endian" : "binary_little_endian") +
                        " 1.0\nelement vertex 4\n" + HEADER_END;
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.5f})
        append(bytes, x, big_endian);
    append(bytes, std::uint8_t{4}, big_endian);
    for (const std::int32_t i : {0, 1, 2, 3})
        append(bytes, i, big_endian);
    append(bytes, std::uint8_t{3}, big_endian);
    for (const std::int32_t i : {0, 1, 2})
        append(bytes, i, big_endian);
    return bytes;
}

void expect_square(const MeshShape& mesh) {
    EXPECT_EQ(mesh.positions, (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5f}));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 1, 2}));
    EXPECT_TRUE(mesh.normals.empty());
}

void expect_refused(const std::string& name, const std::string& bytes, int line, int column,
                    const std::string& message) {
    const Caught error = error_of([&] { parse_mesh(name, bytes); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.file, name);
    EXPECT_EQ(error.line, line) << error.text;
    EXPECT_EQ(error.column, column) << error.text;
    EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
}

} // namespace

TEST(Ply, AsciiAndBothBinaryFormsAreTheSameMesh) {
    expect_square(parse_mesh("a.ply", ascii_ply()));
    expect_square(parse_mesh("a.ply", binary_ply(false)));
    expect_square(parse_mesh("a.PLY", binary_ply(true)));
}

TEST(Ply, NormalsTextureCoordinatesAndUnknownPropertiesAreRead) {
    const MeshShape mesh = parse_mesh(
        "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                 "property double z\nproperty uchar red\nproperty float nx\nproperty float ny\n"
                 "property float nz\nproperty float s\nproperty float t\nelement face 1\n"
                 "property uchar flag\nproperty list ushort uint vertex_index\n"
                 "property list uchar float weights\nelement edge 1\nproperty int a\nend_header\n"
                 "0 0 0 255 0 0 1 0 0\n1 0 0 255 0 0 1 1 0\n0 1 0 255 0 0 1 0 1\n"
                 "9 3 0 1 2 2 0.5 0.5\n7\n");
    EXPECT_EQ(mesh.normals, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
    EXPECT_EQ(mesh.texture_coordinates, (std::vector<float>{0, 0, 1, 0, 0, 1}));
    EXPECT_EQ(mesh.indices.size(), 3u);
}

TEST(Ply, Case07BadValuesAreRefusedNamingVertexOrFace) {
    expect_refused("a.ply", replaced(ascii_ply(), "1 1 0\n", "1 nan 0\n"), 13, 3,
                   "y of vertex 2 is nan");
    expect_refused("a.ply", replaced(ascii_ply(), "1 1 0\n", "1 1 2e18\n"), 13, 5,
                   "z of vertex 2 is 2e+18");
    expect_refused("a.ply", replaced(ascii_ply(), "1 1 0\n", "1 1 1e400\n"), 13, 5, "vertex 2");
    expect_refused("a.ply", replaced(ascii_ply(), "1 1 0\n", "1 one 0\n"), 13, 3, "\"one\"");
    expect_refused("a.ply", replaced(ascii_ply(), "4 0 1 2 3", "4 0 1 2 7"), 15, 9,
                   "face 0 refers to vertex 7 of 4");
    expect_refused("a.ply", replaced(ascii_ply(), "4 0 1 2 3", "4 0 1 2 -1"), 15, 9, "face 0");
    expect_refused("a.ply", replaced(ascii_ply(), "3 0 1 2\n", "2 0 1\n"), 16, 1,
                   "face 1 has 2 corners");
    expect_refused("a.ply", replaced(ascii_ply(), "3 0 1 2\n", ""), 16, 1, "the file ends");
    std::string binary = binary_ply(false);
    const float not_a_number = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(binary.data() + binary.find("end_header\n") + 11 + 16, &not_a_number, 4);
    expect_refused("a.ply", binary, 0, 0, "y of vertex 1 (at byte ");
}

TEST(Ply, BadHeadersAreRefusedAtTheirLine) {
    const std::string good = ascii_ply();
    expect_refused("a.ply", "plx\n", 1, 1, "not a PLY file");
    expect_refused("a.ply", "", 1, 1, "does not end");
    expect_refused("a.ply", replaced(good, "ascii 1.0", "ascii 2.0"), 2, 1, "format");
    expect_refused("a.ply", replaced(good, "property float x", "property real x"), 5, 1,
                   "\"real\"");
    expect_refused("a.ply", replaced(good, "property float x\n", ""), 4, 1, "no x, y and z");
    expect_refused("a.ply", replaced(good, "vertex_indices", "corners"), 8, 1, "vertex_indices");
    expect_refused("a.ply", replaced(good, "element face 2", "elemnt face 2"), 8, 1, "\"elemnt\"");
    expect_refused("a.ply", "ply\nend_header\n", 2, 1, "no format");
}

TEST(Ply, Case36CountsBeyondTheFileAreRefusedBeforeMemoryIsTaken) {
    for (const char* count : {"-1", "4000000000", "9223372036854775808", "18446744073709551615",
                              "99999999999999999999", "4.0"}) {
        expect_refused("a.ply", replaced(ascii_ply(), "vertex 4", "vertex " + std::string(count)),
                       4, 1, "vertex");
        expect_refused("a.ply", replaced(ascii_ply(), "face 2", "face " + std::string(count)), 8, 1,
                       "face");
    }
    expect_refused("a.ply", replaced(ascii_ply(), "4 0 1 2 3", "4000000000 0 1 2 3"), 15, 1,
                   "the count of face 0");
}

TEST(Obj, PolygonsAreFannedAndNegativeNumbersCountBackwards) {
    const MeshShape mesh =
        parse_mesh("a.obj", "# square\no thing\nv 0 0 0\nv 1 0 0\r\nv 1 1 0 1\n"
                            "v 0 1 0.5 # last\nusemtl x\nf 1 2 3 4\nf -4 -3 -2\n");
    expect_square(mesh);
}

TEST(Obj, CornersWithTheirOwnNormalsBecomeVertices) {
    const MeshShape mesh =
        parse_mesh("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0.5\nvn 0 0 1\nvn 0 1 0\n"
                            "f 1/1/1 2/2/1 3//1\nf 1/1/2 2/2/1 3//1\nf 1 2 3\n");
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 3, 1, 2, 4, 5, 6}));
    EXPECT_EQ(mesh.positions.size(), 21u);
    ASSERT_EQ(mesh.normals.size(), 21u);
    EXPECT_EQ(mesh.normals[10], 1.0f); // y of the fourth vertex
    EXPECT_EQ(mesh.normals[14], 0.0f); // the fifth has none
    EXPECT_EQ(mesh.texture_coordinates[3], 0.5f);
}

TEST(Obj, Case07BadValuesAreRefusedAtTheirPlace) {
    const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expect_refused("a.obj", "v 0 0 0\nv 1 nan 0\n", 2, 5, "coordinate 2 of vertex 2 is nan");
    expect_refused("a.obj", "v 0 0 0\nv 1 0 2e18\n", 2, 7, "coordinate 3 of vertex 2 is 2e+18");
    expect_refused("a.obj", "v 0 0\n", 1, 6, "coordinate 3 of vertex 1");
    expect_refused("a.obj", "v 0 zero 0\n", 1, 5, "\"zero\"");
    expect_refused("a.obj", start + "f 1 2 4\n", 4, 7, "face 1 refers to vertex 4 of 3");
    expect_refused("a.obj", start + "f 1 2 0\n", 4, 7, "refers to vertex 0");
    expect_refused("a.obj", start + "f 1 2 -4\n", 4, 7, "refers to vertex -4");
    expect_refused("a.obj", start + "f 1 2 9223372036854775808\n", 4, 7, "no vertex number");
    expect_refused("a.obj", start + "f 1 2 3//1\n", 4, 7, "refers to normal 1 of 0");
    expect_refused("a.obj", start + "f 1 2\n", 4, 6, "face 1 has 2 corners");
    expect_refused("a.obj", start, 0, 0, "no faces");
    expect_refused("a.stl", start, 0, 0, ".ply or .obj");
}

TEST(Mesh, SmoothNormalsOfVerticesWithoutAreaAreZero) {
    MeshShape mesh = parse_mesh("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
    add_smooth_normals(mesh);
    EXPECT_EQ(mesh.normals, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0}));
}

TEST(Mesh, Case36TruncationAtEveryByteIsAnErrorOrAMesh) {
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
    const std::pair<const char*, std::string> files[] = {{"a.ply", ascii_ply()},
                                                         {"a.ply", binary_ply(false)},
                                                         {"a.ply", binary_ply(true)},
                                                         {"a.obj", obj}};
    for (const auto& [name, bytes] : files)
        for (std::size_t size = 0; size < bytes.size(); ++size)
            try {
                const MeshShape mesh = parse_mesh(name, bytes.substr(0, size));
                EXPECT_FALSE(mesh.indices.empty());
            } catch (const Error& error) {
                EXPECT_EQ(error.exit_code(), 2);
            }
}
