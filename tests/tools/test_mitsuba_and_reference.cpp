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

TEST_F(MitsubaCommands, WhateverIsConvertedLoads) {
    namespace fs = std::filesystem;
    const fs::path root = RERADIANT_SOURCE_DIR;
    int scenes = 0;
    for (const auto& entry : fs::directory_iterator(root / "tools/examples/mitsuba"))
        if (entry.path().extension() == ".xml") {
            const std::string name = entry.path().stem().string() + ".toml";
            ASSERT_EQ(run("convert '" + entry.path().string() + "' " + name).exit_code, 0) << name;
            EXPECT_EQ(run("validate " + name + " --quiet").errors, "") << name;
            ++scenes;
        }
    EXPECT_GE(scenes, 8);
    for (const auto& entry : fs::directory_iterator(root / "spectra/reradiation"))
        for (const char* ending : {".csv", ".exr", ".bfc"}) {
            if (entry.path().extension() != ".csv")
                continue;
            const std::string name = std::string("matrix") + ending;
            const ProgramResult made = run("convert '" + entry.path().string() + "' " + name);
            ASSERT_EQ(made.exit_code, 0) << made.errors;
            EXPECT_EQ(run("info " + name).exit_code, 0) << name;
        }
    put("wide.csv", "nm,value\n380,0.5\n500.25,1e-300\n780,0.75\n");
    ASSERT_EQ(run("convert wide.csv wide.spd --json done.json").exit_code, 0);
    EXPECT_EQ(run("validate wide.spd --quiet").exit_code, 0);
    EXPECT_NE(file_bytes(folder / "done.json").find("spectrum"), std::string::npos);
}

TEST_F(MitsubaCommands, WhatWouldNotLoadIsPlacedInTheXml) {
    const std::string before = "<rgb name=\"reflectance\" value=\"0.6, 0.3, 0.1\"/>";
    put("triangle.obj", "v -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put("scene.xml",
        replaced(mitsuba_scene, before,
                 "<spectrum name=\"reflectance\" type=\"irregular\"><string "
                 "name=\"wavelengths\" value=\"400, 600, 500\"/><string name=\"values\" "
                 "value=\"0.1, 0.2, 0.3\"/></spectrum>"));
    expect_failure(2, "convert scene.xml scene.toml", "scene.xml:9:68: 500 nm follows 600 nm");
    put("scene.xml", replaced(mitsuba_scene, before,
                              "<spectrum name=\"reflectance\" value=\"400:0.5, 700:1.5\"/>"));
    expect_failure(2, "convert scene.xml scene.toml", "scene.xml:9:22: reflectance");
    put("scene.xml", replaced(mitsuba_scene, "value=\"8\"", "value=\"0\""));
    expect_failure(2, "convert scene.xml scene.toml", "scene.xml:4:1: width is 0");
    put("scene.xml", mitsuba_scene);
    put("triangle.obj", "v -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
    expect_failure(2, "convert scene.xml scene.toml", "triangle.obj:4:");
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
