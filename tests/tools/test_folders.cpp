#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

/// Folders that the environment names for caches and temporary files: where one cannot be used,
/// the program says so and takes another.
class Folders : public ProgramTest {
protected:
    void SetUp() override {
        put("scene.toml", small_scene());
        put("file", "no folder");
        fs::create_directory(folder / "home");
    }
    std::string here(const std::string& name) const { return (folder / name).string(); }

    /// The program finds its device, and each of `said` is part of a warning.
    void expect_warning(const std::string& environment,
                        const std::vector<std::string>& said) const {
        const ProgramResult result = run("devices", environment);
        EXPECT_EQ(result.exit_code, 0) << environment << "\n" << result.errors;
        for (const std::string& text : said)
            EXPECT_NE(result.errors.find(text), std::string::npos) << environment << "\n"
                                                                   << result.errors;
        if (said.empty()) {
            EXPECT_EQ(result.errors, "") << environment;
        }
    }
};

} // namespace

TEST_F(Folders, WhatCannotBeUsedIsNamedAndAnotherTaken) {
    const std::string own = "RERADIANT_CACHE=" + here("cache") + " ";
    for (const char* bad : {"/proc/nowhere", "file"}) {
        const std::string place = bad == std::string("file") ? here("file") : bad;
        expect_warning(own + "POCL_CACHE_DIR=" + place, {"$POCL_CACHE_DIR, " + place});
        expect_warning("RERADIANT_CACHE=" + place + " HOME=" + here("home"),
                       {"$RERADIANT_CACHE, " + place, "go to " + here("home/.cache/reradiant")});
        expect_warning("-u RERADIANT_CACHE XDG_CACHE_HOME=" + place + " HOME=" + here("home"),
                       {"$XDG_CACHE_HOME", place, "go to " + here("home")});
        expect_warning("-u RERADIANT_CACHE -u XDG_CACHE_HOME HOME=" + place +
                           " TMPDIR=" + here("home"),
                       {"$HOME", place, "go to " + here("home/reradiant-")});
        // Temporary files are not needed here.
        expect_warning(own + "TMPDIR=" + place, {});
        expect_warning("-u RERADIANT_CACHE -u XDG_CACHE_HOME -u HOME TMPDIR=" + place,
                       {"$TMPDIR, " + place, "/tmp"});
    }
    expect_warning("-u RERADIANT_CACHE -u XDG_CACHE_HOME -u HOME TMPDIR=" + here("home"), {});
}

TEST_F(Folders, KernelsAreBuiltWhereNoFolderThatIsNamedCanBeUsed) {
    const ProgramResult made = run(
        "render scene.toml -o out.exr --spp 1",
        "-u XDG_CACHE_HOME RERADIANT_CACHE=/proc/a POCL_CACHE_DIR=/proc/b HOME=/proc/c TMPDIR=" +
            here("home"));
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    EXPECT_TRUE(fs::exists(folder / "out.exr"));
    for (const char* text : {"/proc/a", "/proc/b", "/proc/c"})
        EXPECT_NE(made.errors.find(text), std::string::npos) << made.errors;
}

TEST_F(Folders, Case71DriversThatDoNotLoadAreNamed) {
    fs::create_directory(folder / "vendors");
    fs::copy_file("/etc/OpenCL/vendors/pocl.icd", folder / "vendors/pocl.icd");
    put("vendors/absent.icd", "libno-such-driver.so.1\n");
    put("vendors/wrong.icd", "libm.so.6\n");
    put("vendors/empty.icd", "\n");
    const std::string environment = "OCL_ICD_VENDORS=" + here("vendors");
    const ProgramResult some = run("devices --json devices.json", environment);
    EXPECT_EQ(some.exit_code, 0) << some.errors;
    for (const char* text : {"absent.icd did not load: libno-such-driver.so.1: cannot open",
                             "wrong.icd did not load: it is no OpenCL driver",
                             "empty.icd did not load: it names no library"})
        EXPECT_NE(some.errors.find(text), std::string::npos) << some.errors;
    EXPECT_EQ(some.errors.find("pocl.icd"), std::string::npos) << some.errors;
    const auto json = nlohmann::json::parse(file_bytes(folder / "devices.json"));
    ASSERT_EQ(json["not_loaded"].size(), 3u);
    EXPECT_EQ(json["not_loaded"][0]["library"], "libno-such-driver.so.1");

    fs::remove(folder / "vendors/pocl.icd");
    expect_failure(1, "devices", "absent.icd did not load", environment);
    expect_failure(1, "render scene.toml -o out.exr", "no OpenCL device was found; ", environment);
}

} // namespace reradiant
