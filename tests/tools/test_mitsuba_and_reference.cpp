#include "tests/tools/program_runner.h"

namespace reradiant {

namespace {

using MitsubaCommands = ProgramTest;
using Reference = ProgramTest;

const char* const mitsuba_scene = R"(<scene version="3.0.0">
<sensor type="perspective"><float name="fov" value="40"/>
<transform name="to_world"><lookat origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film>
</sensor>
<emitter type="constant"/>
<shape type="obj"><string name="filename" value="triangle.obj"/>
<transform name="to_world"><scale value="2"/></transform>
<bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.3, 0.1"/></bsdf></shape>
</scene>
)";

} // namespace

TEST_F(MitsubaCommands, ConvertedSceneRendersAsTheXmlDoes) {
    put("scene.xml", mitsuba_scene);
    put("triangle.obj", "v -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::filesystem::create_directory(folder / "out");
    ASSERT_EQ(run("convert scene.xml out/scene.toml").exit_code, 0);
    EXPECT_NE(file_bytes(folder / "out" / "scene.toml").find("../triangle.obj"), std::string::npos);
    EXPECT_NE(run("validate scene.xml").output.find("triangles: 1"), std::string::npos);
    const std::string options = " --spp 2 --bands 400:700:100 --quiet";
    ASSERT_EQ(run("render scene.xml -o a.exr" + options).exit_code, 0);
    ASSERT_EQ(run("render out/scene.toml -o b.exr" + options).exit_code, 0);
    EXPECT_EQ(run("compare a.exr b.exr --max-relmse 0").exit_code, 0);
}

TEST_F(MitsubaCommands, RefusalsNameThePlaceAndLeaveNothing) {
    put("scene.xml", std::string(mitsuba_scene).replace(0, 7, "<scene\n"));
    expect_failure(2, "convert scene.xml scene.toml", "scene.xml:8:19: cannot open");
    expect_failure(2, "render scene.xml -o a.exr", "scene.xml:8:19: cannot open");
    expect_failure(2, "convert scene.xml scene.csv", "scene.csv: a scene is written as .toml");
}

TEST_F(Reference, HoldsEveryTableOfTheLoader) {
    const ProgramResult result = run("validate --reference");
    EXPECT_EQ(result.exit_code, 0) << result.errors; // fails for keys and types that were not met
    EXPECT_EQ(result.errors, "");
    for (const char* text :
         {"| `fov_deg` | number, above 0 and below 180 | 35 |", "## [[light]] (environment)",
          "## [[material]].substrate (conductor)", "## SPECTRUM by line_nm",
          "one of multiple, single", "| `max_depth` | whole number, 1 to 10000 | 8 |"})
        EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
}

} // namespace reradiant
