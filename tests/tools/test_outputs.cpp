#include "tests/tools/program_runner.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

const std::string shipped = std::string(RERADIANT_SOURCE_DIR) + "/spectra/reradiation/";
const std::string orange = shipped + "synthetic-orange.csv";
const std::string examples = std::string(RERADIANT_SOURCE_DIR) + "/tools/examples/";

/// These tests name outputs on the command line that are wrong in one way or another: that is found
/// out before anything is read that takes time, with nothing written.
class Outputs : public ProgramTest {
protected:
    void SetUp() override {
        put("scene.toml", small_scene());
        put("material.toml", "[material]\n[material.substrate]\ntype = \"lambert\"\n");
        put("study.toml", "[study]\nscene = \"scene.toml\"\n[render]\nspp = 2\n"
                          "[[sweep]]\nkey = \"material.grey.substrate.reflectance\"\n"
                          "values = [0.2, 0.8]\n");
    }
    void link(const std::string& target, const std::string& name) const {
        fs::create_symlink(target, folder / name);
    }
    bool exists(const std::string& name) const { return fs::exists(folder / name); }
};

/// Commands whose output `NAME` stands for, each with the ending that it wants.
const std::pair<const char*, const char*> commands[] = {
    {"render scene.toml -o NAME --spp 1", ".exr"},
    {"render scene.toml -o ok.exr --spp 1 --png NAME", ".png"},
    {"render scene.toml -o ok.exr --spp 1 --json NAME", ".json"},
    {"measure material.toml -o NAME", ".csv"},
    {"measure material.toml -o ok.csv --json NAME", ".json"},
    {"synth EXAMPLES/synth-orange.toml -o NAME", ".csv"},
    {"synth EXAMPLES/synth-orange.toml -o ok.csv --truth NAME", ".bfc"},
    {"fit ORANGE -o NAME", ".csv"},
    {"fit ORANGE -o ok.csv --report NAME", ".html"},
    {"fit ORANGE -o ok.csv --model-file NAME", ".toml"},
    {"colour ORANGE --plot NAME", ".svg"},
    {"colour ORANGE --json NAME", ".json"},
    {"compare missing.exr missing.exr --json NAME", ".json"},
    {"merge missing.exr -o NAME", ".exr"},
    {"merge missing.exr -o ok.exr --png NAME", ".png"},
    {"check --save NAME", ".json"},
    {"check --json NAME", ".json"},
    {"classify --class a -o NAME", ".toml"},
    {"validate missing.toml --json NAME", ".json"},
    {"info missing.toml --json NAME", ".json"},
    {"devices --json NAME", ".json"},
    {"convert ORANGE NAME", ".csv"},
    {"study study.toml -o results --json NAME", ".json"},
    {"converge scene.toml -o errors --json NAME", ".json"},
};

std::string with_name(const std::string& command, const std::string& name) {
    std::string line = command;
    for (const auto& [word, text] : {std::pair<std::string, std::string>{"NAME", name},
                                     {"ORANGE", orange},
                                     {"EXAMPLES/", examples}})
        if (const std::size_t at = line.find(word); at != std::string::npos)
            line.replace(at, word.size(), text);
    return line;
}

} // namespace

TEST_F(Outputs, AFolderThatIsNotThereIsFoundFirst) {
    for (const auto& [command, ending] : commands) {
        const std::string name = std::string("nowhere/out") + ending;
        expect_failure(2, with_name(command, name), name + ": the folder nowhere does not exist");
    }
}

TEST_F(Outputs, AFolderInPlaceOfAFileIsFoundFirst) {
    for (const auto& [command, ending] : commands) {
        const std::string name = std::string("full") + ending;
        fs::create_directory(folder / name);
        expect_failure(2, with_name(command, name), name + ": is a folder, not a file");
        fs::remove(folder / name);
    }
}

TEST_F(Outputs, LinksInACircleAreFoundFirst) {
    for (const auto& [command, ending] : commands) {
        const std::string name = std::string("a") + ending, other = std::string("b") + ending;
        link(other, name);
        link(name, other);
        expect_failure(2, with_name(command, name), name + ": symbolic links lead round");
        fs::remove(folder / name);
        fs::remove(folder / other);
    }
}

TEST_F(Outputs, AFolderThatTakesNoFilesIsFoundFirst) {
    // Not even the superuser writes there.
    for (const auto& [command, ending] : commands)
        expect_failure(2, with_name(command, std::string("/proc/out") + ending),
                       "the folder /proc cannot be written to");
    for (const char* command : {"study study.toml -o ", "converge scene.toml -o "}) {
        expect_failure(2, std::string(command) + "/proc/results", "cannot be written to");
        expect_failure(2, std::string(command) + "/proc", "cannot be written to");
        expect_failure(2, std::string(command) + "scene.toml", "is a file, not a folder");
        expect_failure(2, std::string(command) + "nowhere/results", "does not exist");
    }
}

TEST_F(Outputs, AnEndingOfAnotherFormatIsRefused) {
    for (const auto& [command, ending] : commands) {
        const std::string name =
            std::string("out") + (ending == std::string(".png") ? ".exr" : ".png");
        expect_failure(2, with_name(command, name), name + ": ");
    }
    for (const char* name : {"out", "/dev/stdout"})
        expect_failure(2, with_name("fit ORANGE -o NAME", name), std::string(name) + ": ");
}

TEST_F(Outputs, TheOptionThatWasMeantIsNamed) {
    const std::pair<const char*, const char*> meant[] = {
        {"render scene.toml -o x.png", "x.png: -o writes .exr, and the name ends in .png; use "
                                       "--png x.png for that, and name a .exr here"},
        {"render scene.toml -o x.exr --png y.EXR", "use -o y.EXR for that"},
        {"render scene.toml -o x.json", "use --json x.json for that"},
        {"measure material.toml -o x.exr", "x.exr: -o writes .csv"},
        {"measure material.toml -o x.txt", "x.txt: -o writes .csv"},
        {"merge a.exr -o x.png", "use --png x.png for that"},
        {"fit ORANGE -o x.html", "use --report x.html for that"},
        {"fit ORANGE -o x.toml", "use --model-file x.toml for that"},
        {"fit ORANGE -o x.csv --report x.csv", "use -o x.csv for that"},
        {"colour ORANGE --json x.svg", "use --plot x.svg for that"},
        {"synth EXAMPLES/synth-orange.toml -o x.exr", "use --truth x.exr for that"},
        {"study study.toml -o x.png", "x.png: -o names a folder here"},
        {"converge scene.toml -o errors.csv", "errors.csv: -o names a folder here"},
        {"check --save x.csv", "x.csv: --save writes .json"},
    };
    for (const auto& [command, message] : meant)
        expect_failure(2, with_name(command, ""), message);
    // The letters behind the last dot need not be a format.
    EXPECT_EQ(run("measure material.toml -o part.001").exit_code, 0);
    fs::create_directory(folder / "old.png");
    EXPECT_EQ(run("study study.toml -o old.png --quiet").exit_code, 0) << "it is a folder";
}

TEST_F(Outputs, OneFileForTwoOutputsOrForAnInputIsRefused) {
    link("ok.exr", "also.png");
    fs::create_directory(folder / "sub");
    expect_failure(2, "render scene.toml -o ok.exr --png also.png", "name the same file");
    expect_failure(2, "render scene.toml -o out --json sub/../out", "name the same file");
    expect_failure(2, "colour m.csv --against x.csv --json x.csv", "x.csv: ");
    put("data.csv", file_bytes(orange));
    link("data.csv", "link.csv");
    expect_failure(2, "fit data.csv -o link.csv", "write over what is read");
    EXPECT_EQ(file_bytes(folder / "data.csv"), file_bytes(orange));
}

TEST_F(Outputs, DisplaysAndAddressesAreCheckedFirst) {
    put("nodisplay.ocio", "ocio_profile_version: 1\nroles:\n  default: raw\n  scene_linear: lin\n"
                          "colorspaces:\n  - !<ColorSpace>\n    name: lin\n  - !<ColorSpace>\n"
                          "    name: raw\n    isdata: true\n");
    put("missinglut.ocio",
        "ocio_profile_version: 1\nsearch_path: luts\nroles:\n  default: raw\n  scene_linear: lin\n"
        "displays:\n  monitor:\n    - !<View> {name: Film, colorspace: film}\ncolorspaces:\n"
        "  - !<ColorSpace>\n    name: lin\n  - !<ColorSpace>\n    name: raw\n    isdata: true\n"
        "  - !<ColorSpace>\n    name: film\n"
        "    from_reference: !<FileTransform> {src: \"$SHOT.cube\", interpolation: linear}\n");
    put("broken.ocio", "ocio_profile_version: 2\nroles:\n  scene_linear: nothing\n");
    const std::string render = "render scene.toml -o out.exr --png out.png --spp 1 ";
    expect_failure(2, render + "--display nosuch", "'nosuch'");
    expect_failure(2, render + "--view nosuch", "'nosuch'");
    expect_failure(2, "render scene.toml -o out.exr --display nosuch", "'nosuch'");
    expect_failure(2, render + "--exposure nan", "--exposure");
    expect_failure(2, render + "--tev nonsense", "--tev 'nonsense'");
    for (const std::string config : {"missing", "nodisplay", "missinglut", "broken"}) {
        const std::string file = config + ".ocio";
        expect_failure(2, render + "--ocio " + file, file + ": ");
        for (const char* command :
             {"render scene.toml -o out.exr --png out.png --spp 1",
              "merge a.exr -o o.exr --png o.png", "study study.toml -o results",
              "converge scene.toml -o errors --time 0.1"})
            expect_failure(2, command, file + ": ", "OCIO=" + file);
    }
    // A picture that nobody asked for needs no display.
    EXPECT_EQ(run("render scene.toml -o out.exr --spp 1", "OCIO=missing.ocio").exit_code, 0);
    expect_failure(2, "check --against missing.json", "missing.json: ");
}

TEST_F(Outputs, LinksAreWrittenThrough) {
    fs::create_directory(folder / "there");
    put("there/old.csv", "old");
    fs::permissions(folder / "there/old.csv", fs::perms(0640));
    link("there/old.csv", "one.csv");
    link("one.csv", "two.csv");
    link("there/new.csv", "dangling.csv");
    for (const char* name : {"two.csv", "dangling.csv"}) {
        const ProgramResult made = run(std::string("measure material.toml -o ") + name);
        EXPECT_EQ(made.exit_code, 0) << made.errors;
        EXPECT_TRUE(fs::is_symlink(folder / name));
    }
    EXPECT_TRUE(fs::is_symlink(folder / "one.csv"));
    EXPECT_GT(file_bytes(folder / "there/old.csv").size(), 100u);
    EXPECT_EQ(file_bytes(folder / "there/old.csv"), file_bytes(folder / "there/new.csv"));
    EXPECT_EQ(fs::status(folder / "there/old.csv").permissions(), fs::perms(0640));
    link("nowhere/out.csv", "lost.csv");
    expect_failure(2, "measure material.toml -o lost.csv", "the folder nowhere does not exist");
}

TEST_F(Outputs, StreamsGetTheBytes) {
    ASSERT_EQ(run("measure material.toml -o file.csv").exit_code, 0);
    const std::string expected = file_bytes(folder / "file.csv");
    const ProgramResult piped = run("measure material.toml -o /dev/stdout --quiet | cat");
    EXPECT_EQ(piped.output, expected);
    // /dev/stdout is a link to a regular file here: it goes on where the shell's own output ends.
    const ProgramResult redirected = run("measure material.toml -o /dev/stdout --quiet");
    EXPECT_EQ(redirected.output, expected) << redirected.errors;
    put("log", "before\n");
    run("measure material.toml -o /dev/stdout --quiet >>log #");
    EXPECT_EQ(file_bytes(folder / "log"), "before\n" + expected);
    EXPECT_EQ(run("measure material.toml -o /dev/null").exit_code, 0);
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    run("measure material.toml -o pipe --quiet | cat pipe >got #");
    EXPECT_EQ(file_bytes(folder / "got"), expected);
    EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
    // Who has no reader yet says so, and goes on with the first.
    run("measure material.toml -o pipe 2>waits & cd '" + (folder / "").string() +
        "' && timeout 20 sh -c 'until grep waiting waits; do sleep 0.1; done' && cat pipe >late #");
    EXPECT_EQ(file_bytes(folder / "late"), expected);
    // Images are written with seeks, which pipes do not take.
    ASSERT_EQ(run("render scene.toml -o image.exr --spp 1 --quiet").exit_code, 0);
    run("render scene.toml -o /dev/stdout --spp 1 --quiet | cat >copy.exr #");
    EXPECT_EQ(run("compare image.exr copy.exr --max-relmse 0").exit_code, 0);
    EXPECT_FALSE(exists("pipe.checkpoint"));
}

TEST_F(Outputs, WhatIsReadIsNotWrittenOver) {
    ASSERT_EQ(run("render scene.toml -o a.exr --sample-range 0:1 --quiet").exit_code, 0);
    ASSERT_EQ(run("render scene.toml -o b.exr --sample-range 1:2 --quiet").exit_code, 0);
    const std::string part = file_bytes(folder / "a.exr");
    expect_failure(2, "merge a.exr b.exr -o a.exr", "would write over what is read");
    put("lit.toml",
        small_scene() + "[[texture]]\nname = \"t\"\ntype = \"image\"\nfile = \"a.exr\"\n");
    expect_failure(2, "render lit.toml --spp 1 -o a.exr", "would write over what is read");
    EXPECT_EQ(file_bytes(folder / "a.exr"), part);
    for (const char* command :
         {"compare a.exr b.exr --max-relmse nan", "render scene.toml -o c.exr --time nan",
          "measure material.toml "
          "-o m.csv --checkpoint nan"})
        EXPECT_EQ(run(command).exit_code, 2) << command;
}

TEST_F(Outputs, WhatAFileNamesIsReadToo) {
    put("m.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                 "nm,400,410\n400,0.5,0\n410,0.1,0.5\n");
    put("dark.csv", "nm,value\n300,0.2\n780,0.2\n");
    put("dyed.toml", "[material]\nname = \"m\"\n  [material.substrate]\n  type = \"lambert\"\n"
                     "  reradiation = { file = \"m.csv\" }\n");
    put("recipe.toml",
        "emission_nm = { from = 400, to = 700, step = 20 }\n"
        "excitation_nm = { from = 400, to = 700, step = 20 }\n"
        "reflectance = { file = \"dark.csv\" }\n"
        "[[fluorophore]]\nabsorptance = 0.5\nexcitation = [{ peak_nm = 450, width_nm = 60 }]\n"
        "emission = { peak_nm = 560, width_nm = 40 }\nquantum_yield = 0.5\n");
    const std::string matrix = file_bytes(folder / "m.csv");
    expect_failure(2, "measure dyed.toml -o m.csv", "would write over what is read");
    expect_failure(2, "synth recipe.toml -o dark.csv", "would write over what is read");
    expect_failure(2, "convert m.csv m.csv --out-rows excitation", "would write over what is read");
    EXPECT_EQ(file_bytes(folder / "m.csv"), matrix);
}

TEST_F(Outputs, NamesAsLongAsTheyCanBe) {
    const std::string name = std::string(251, 'n') + ".csv";
    EXPECT_EQ(run("measure material.toml -o " + name).exit_code, 0);
    EXPECT_TRUE(exists(name));
    expect_failure(2, "measure material.toml -o n" + name, "the name is too long");
}

TEST_F(Outputs, JsonMayLieInTheFolderThatAStudyMakes) {
    const ProgramResult made =
        run("converge scene.toml -o errors --json errors/all.json --time 0.2 "
            "--spp-reference 4 --methods auto");
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    EXPECT_TRUE(exists("errors/all.json"));
}

} // namespace reradiant
