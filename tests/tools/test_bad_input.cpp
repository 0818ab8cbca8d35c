#include "tests/tools/program_runner.h"

namespace reradiant {

namespace {

/// Scenes and materials that are wrong in one place: every command that reads them refuses them
/// at that place, with exit code 2 and without leaving a file.
class BadInput : public ProgramTest {
protected:
    void expect_scene_refused(const std::string& text, const std::string& place) const {
        put("scene.toml", text);
        for (const char* arguments : {"render scene.toml -o out.exr --png out.png --json out.json",
                                      "validate scene.toml", "info scene.toml --json out.json"})
            expect_failure(2, arguments, place);
    }
};

const std::string substrate = "reflectance = 0.5";

} // namespace

TEST_F(BadInput, MissingFilesAreNamed) {
    for (const char* arguments :
         {"render missing.toml -o out.exr", "measure missing.toml -o out.csv",
          "validate missing.toml", "info missing.toml", "convert missing.csv out.exr"})
        expect_failure(2, arguments, "missing.");
}

TEST_F(BadInput, UnknownKeyIsPlacedByLineAndColumn) {
    expect_scene_refused(replaced(small_scene(), "height = 6\n", "height = 6\nheigth = 6\n"),
                         "scene.toml:4:1: ");
}

TEST_F(BadInput, WrongTypeAndWrongLengthArePlaced) {
    expect_scene_refused(replaced(small_scene(), "height = 6", "height = \"six\""),
                         "scene.toml:3:");
    expect_scene_refused(replaced(small_scene(), "[0, 0, 3]", "[0, 0]"), "scene.toml:5:");
}

TEST_F(BadInput, BrokenTomlIsPlaced) {
    expect_scene_refused(replaced(small_scene(), "height = 6", "height = = 6"), "scene.toml:3:");
}

TEST_F(BadInput, MissingReferenceIsPlacedAtItsKey) {
    expect_scene_refused(replaced(small_scene(), substrate, "reradiation = { file = \"no.csv\" }"),
                         "scene.toml:19:");
}

TEST_F(BadInput, Case25MatrixThatBreaksEnergyIsRefused) {
    put("hot.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                   "nm,400,500\n400,0.5,0\n500,0.501,0.5\n");
    expect_scene_refused(replaced(small_scene(), substrate, "reradiation = { file = \"hot.csv\" }"),
                         "400");
}

TEST_F(BadInput, GridThatDoesNotFitIsPlaced) {
    expect_scene_refused(replaced(small_scene(), "height = 6\n",
                                  "height = 6\nbands_nm = { from = 400, to = 705, step = 10 }\n"),
                         "scene.toml:4:");
}

TEST_F(BadInput, Case07NanInAMeshNamesTheVertex) {
    put("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
    expect_scene_refused(replaced(small_scene(),
                                  "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1",
                                  "type = \"mesh\"\nfile = \"bad.obj\""),
                         "bad.obj:3");
}

TEST_F(BadInput, CameraAtItsTargetAndAbsurdFilmArePlaced) {
    expect_scene_refused(replaced(small_scene(), "[0, 0, 3]", "[0, 0, 0]"), "scene.toml:");
    expect_scene_refused(replaced(small_scene(), "width = 8", "width = 65537"), "scene.toml:2:");
    expect_scene_refused(replaced(small_scene(), "width = 8", "width = -1"), "scene.toml:2:");
}

TEST_F(BadInput, MaterialIsRefusedByMeasureAtItsPlace) {
    put("material.toml", "[material]\nname = \"grey\"\n[material.substrate]\n"
                         "type = \"lambert\"\nreflectance = 1.5\n");
    expect_failure(2, "measure material.toml -o out.csv", "material.toml:5:");
}

TEST_F(BadInput, Case36HostileTomlIsRefusedQuickly) {
    expect_scene_refused("x = " + std::string(100000, '['), "scene.toml");
    expect_scene_refused(std::string(1000, '\0'), "scene.toml");
}

} // namespace reradiant
