#include "reradiant/scene_file.h"
#include "tests/scene/scratch.h"

#include <filesystem>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

/// One edit of the small scene and where and how it must be refused.
struct BadScene {
    const char* name;
    std::string from, to;
    int line, column;
    std::string message;
};

std::ostream& operator<<(std::ostream& stream, const BadScene& bad) {
    return stream << bad.name;
}

class BadSceneFile : public Scratch, public ::testing::WithParamInterface<BadScene> {};

TEST_P(BadSceneFile, IsRefusedAtItsPlace) {
    const BadScene& bad = GetParam();
    const auto file = write("scene.toml", replaced(SMALL_SCENE, bad.from, bad.to));
    const Caught error = error_of([&] { load_scene(file); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.file, file.string());
    EXPECT_EQ(error.line, bad.line) << error.text;
    EXPECT_EQ(error.column, bad.column) << error.text;
    EXPECT_NE(error.text.find(bad.message), std::string::npos) << error.text;
}

const BadScene BAD_SCENES[] = {
    // Keys.
    {"UnknownKey", "width = 8", "widht = 8", 2, 1, "did you mean \"width\"?"},
    {"UnknownTable", "[film]", "[fim]", 1, 2, "did you mean \"film\"?"},
    {"UnknownKeyWithNoNeighbour", "height = 4", "zzzzzzzz = 4", 3, 1, "use one of: width, height"},
    {"MissingKey", "width = 8\n", "", 1, 1, "[film] has no \"width\""},
    {"MissingMaterialName", "name = \"grey\"\n", "", 10, 1, "has no \"name\""},
    {"MissingShapeMaterial", "material = \"grey\"\n", "", 15, 1, "has no \"material\""},
    {"MissingType", "type = \"sphere\"\n", "", 15, 1, "has no \"type\""},
    // Types and lengths.
    {"StringForNumber", "width = 8", "width = \"8\"", 2, 1, "write a whole number"},
    {"FractionForInteger", "width = 8", "width = 8.5", 2, 1, "write a whole number"},
    {"BooleanForVector", "origin = [0, 0, 5]", "origin = true", 5, 1, "write an array"},
    {"ShortVector", "origin = [0, 0, 5]", "origin = [0, 5]", 5, 1, "origin has 2 numbers; give 3"},
    {"StringInVector", "origin = [0, 0, 5]", "origin = [0, 0, \"5\"]", 5, 17, "origin[2]"},
    {"TableForArray", "[[light]]", "[light]", 7, 2, "write an array of tables: [[light]]"},
    {"NumberForTable", "[film]\nwidth = 8\nheight = 4", "film = 8\n#\n#", 1, 1, "write a table"},
    {"NumberForString", "material = \"grey\"", "material = 3", 19, 1, "write a string"},
    // Ranges.
    {"NotANumber", "radius = 1", "radius = nan", 18, 1, "radius is nan"},
    {"Infinite", "origin = [0, 0, 5]", "origin = [0, inf, 5]", 5, 14, "origin[1] is inf"},
    {"FilmOfNoWidth", "width = 8", "width = 0", 2, 1, "from 1 to 65536"},
    {"FilmTooLarge", "height = 4", "height = 65537", 3, 1, "from 1 to 65536"},
    {"Case36CountOf2To63", "width = 8", "width = 9223372036854775807", 2, 1, "from 1 to 65536"},
    {"Case36NegativeCount", "width = 8", "width = -1", 2, 1, "from 1 to 65536"},
    {"FieldOfView", "target = [0, 0, 0]", "target = [0, 0, 0]\nfov_deg = 180", 7, 1,
     "above 0 and below 180"},
    {"RadiusZero", "radius = 1", "radius = 0", 18, 1, "above 0"},
    {"RadiusNegative", "radius = 1", "radius = -1", 18, 1, "above 0"},
    {"Case07CoordinateTooLarge", "center = [0, 0, 0]", "center = [0, 2e18, 0]", 17, 14,
     "at most 1e+18"},
    {"ReflectanceAboveOne", "reflectance = 0.5", "reflectance = 1.5", 14, 1, "at most 1"},
    {"ReflectanceNegative", "reflectance = 0.5", "reflectance = -0.5", 14, 1, "at least 0"},
    {"RadianceNegative", "radiance = 1", "radiance = -1", 9, 1, "at least 0"},
    {"Case35RadianceTooLarge", "radiance = 1", "radiance = 1e38", 9, 1, "radiance is 1e+38"},
    // Meaning.
    {"CameraAtItsTarget", "origin = [0, 0, 5]", "origin = [0, 0, 0]", 6, 1,
     "the camera is at its target"},
    {"UpParallelToView", "target = [0, 0, 0]", "target = [0, 0, 0]\nup = [0, 0, -3]", 7, 1,
     "up is parallel"},
    {"DefaultUpParallelToView", "origin = [0, 0, 5]", "origin = [0, 5, 0]", 6, 1, "up is parallel"},
    {"BandsNoWholeNumberOfSteps", "height = 4",
     "height = 4\nbands_nm = { from = 400, to = 705, step = 10 }", 4, 1, "steps"},
    {"BandsBackwards", "height = 4", "height = 4\nbands_nm = { from = 700, to = 400, step = 10 }",
     4, 1, ""},
    {"BandsUnknownKey", "height = 4", "height = 4\nbands_nm = { from = 400, to = 700, steps = 10 }",
     4, 36, "did you mean \"step\"?"},
    {"UnknownMaterialName", "material = \"grey\"", "material = \"gray\"", 19, 1,
     "no material is called \"gray\"; there are: grey"},
    {"UnknownShape", "type = \"sphere\"", "type = \"spehre\"", 16, 1, "did you mean \"sphere\"?"},
    {"UnknownLight", "type = \"environment\"", "type = \"sun\"", 8, 1, "unknown type \"sun\""},
    {"LightOfNoArea", "type = \"environment\"",
     "type = \"rectangle\"\ncenter = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [2, 0, 0]", 11, 1,
     "no area"},
    {"LightWithoutAnEdge", "type = \"environment\"",
     "type = \"rectangle\"\ncenter = [0, 0, 0]\nedge_u = [0, 0, 0]\nedge_v = [2, 0, 0]", 10, 1,
     "no area"},
    {"LightWithoutADirection", "type = \"environment\"\nradiance = 1",
     "type = \"directional\"\ndirection = [0, 0, 0]\nirradiance = 1", 9, 1, "direction is zero"},
    {"TwoMaterialsOfOneName", "[[shape]]",
     "[[material]]\nname = \"grey\"\nsubstrate = { type = \"lambert\" }\n[[shape]]", 16, 1,
     "two materials are called \"grey\""},
    // Files.
    {"MissingMesh", "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1",
     "type = \"mesh\"\nfile = \"none.ply\"", 17, 1, "cannot open \"none.ply\""},
    {"MissingSpectrum", "radiance = 1", "radiance = { file = \"none.spd\" }", 9, 14,
     "cannot open \"none.spd\""},
    {"MissingMatrix", "reflectance = 0.5", "reradiation = { file = \"none.csv\" }", 14, 17,
     "cannot open \"none.csv\""},
    {"FolderForFile", "radiance = 1", "radiance = { file = \".\" }", 9, 14, "cannot open"},
    // Presets.
    {"UnknownPreset", "[material.substrate]\ntype = \"lambert\"\nreflectance = 0.5",
     "preset = \"none\"", 12, 1, "there are: acrylic-lacquer"},
    // Syntax.
    {"Syntax", "height = 4", "height = = 4", 3, 10, "not valid TOML"},
    {"DuplicateKey", "height = 4", "height = 4\nheight = 4", 4, 10, "not valid TOML"},
};

INSTANTIATE_TEST_SUITE_P(All, BadSceneFile, ::testing::ValuesIn(BAD_SCENES),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

} // namespace

using SceneErrors = Scratch;

TEST_F(SceneErrors, AMissingSceneNamesItself) {
    const auto file = folder / "none.toml";
    const Caught error = error_of([&] { load_scene(file); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.file, file.string());
    EXPECT_NE(error.text.find("no such file"), std::string::npos);
}

TEST_F(SceneErrors, AFolderIsNoScene) {
    EXPECT_EQ(error_of([&] { load_scene(folder); }).exit_code, 2);
}

TEST_F(SceneErrors, MatrixThatBreaksEnergyIsRefusedAtItsKey) {
    write("bad.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                     "nm,400,410\n400,0.5,0\n410,0.6,0.5\n");
    const auto file = write("scene.toml", replaced(SMALL_SCENE, "reflectance = 0.5",
                                                   "reradiation = { file = \"bad.csv\" }"));
    const Caught error = error_of([&] { load_scene(file); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.file, file.string());
    EXPECT_EQ(error.line, 14);
    EXPECT_EQ(error.column, 17);
    EXPECT_NE(error.text.find("400"), std::string::npos) << error.text; // names the column
}

TEST_F(SceneErrors, Case07NanInAMeshIsPlacedInTheMesh) {
    const auto mesh = write("bad.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    const auto file = write(
        "scene.toml", replaced(SMALL_SCENE, "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1",
                               "type = \"mesh\"\nfile = \"bad.obj\""));
    const Caught error = error_of([&] { load_scene(file); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.file, mesh.string());
    EXPECT_EQ(error.line, 2);
    EXPECT_EQ(error.column, 5);
    EXPECT_NE(error.text.find("vertex 2"), std::string::npos) << error.text;
}
