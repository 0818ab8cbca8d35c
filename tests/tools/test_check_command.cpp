// `check` as users run it, and devices that lack something, each simulated in a child process by
// what PoCL lets one set (its environment variables).
#include "tests/tools/program_runner.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace reradiant {
namespace {

namespace fs = std::filesystem;

using CheckCommand = ProgramTest;
using BadDevice = ProgramTest;

const std::string quick = "check --only fresnel --samples 100000 ";
const std::string tiny_render = "render scene.toml -o out.exr --spp 1 ";

TEST_F(CheckCommand, ReportsEveryFunctionAndEndsWithZero) {
    const ProgramResult result = run(quick + "--json check.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const auto json = nlohmann::json::parse(file_bytes(folder / "check.json"));
    EXPECT_TRUE(json["passed"]);
    ASSERT_EQ(json["functions"].size(), 4U);
    for (const auto& function : json["functions"]) {
        EXPECT_LE(function["of_budget"].get<double>(), 1.0);
        EXPECT_GT(function["nanoseconds"].get<double>(), 0.0);
        EXPECT_LE(function["ulp_99_9"].get<double>(), function["max_ulp"].get<double>());
    }
}

TEST_F(CheckCommand, EndsWithThreeWhenAFunctionFails) {
    fs::create_directories(folder / "data");
    fs::copy(fs::path(RERADIANT_SOURCE_DIR) / "kernels", folder / "data" / "kernels",
             fs::copy_options::recursive);
    const fs::path file = folder / "data" / "kernels/scatter/fresnel.h";
    put("data/kernels/scatter/fresnel.h",
        replaced(file_bytes(file), "r = REAL(0.5) *", "r = REAL(0.51) *"));
    const ProgramResult result = run(quick, "RERADIANT_DATA=data");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.errors.find("kernels/scatter/fresnel.h: fresnel_dielectric"),
              std::string::npos)
        << result.errors;
}

TEST_F(CheckCommand, SavedResultsHoldOnTheSameDevice) {
    ASSERT_EQ(run(quick + "--save saved.json").exit_code, 0);
    EXPECT_EQ(run(quick + "--against saved.json").exit_code, 0);
    expect_failure(2, quick + "--against nowhere.json", "nowhere.json");
    expect_failure(2, "check --only nonsense", "nonsense");
}

TEST_F(BadDevice, Case37SmallWorkGroupsAreTakenAsTheyAre) {
    put("scene.toml", small_scene());
    for (const std::string size : {"1", "3"}) {
        const std::string environment = "POCL_MAX_WORK_GROUP_SIZE=" + size;
        EXPECT_EQ(run(tiny_render, environment).exit_code, 0) << size;
        EXPECT_EQ(run(quick, environment).exit_code, 0) << size;
    }
}

TEST_F(BadDevice, LittleMemoryIsNamedBeforeItRunsOut) {
    // the film of 3000 x 2000 pixels takes over 1 GB in one array
    put("scene.toml", replaced(replaced(small_scene(), "width = 8", "width = 3000"), "height = 6",
                               "height = 2000"));
    const ProgramResult result =
        run(tiny_render + "--memory-limit 100000000000", "POCL_MEMORY_LIMIT=1");
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    EXPECT_NE(result.errors.find("allocates at most"), std::string::npos) << result.errors;
    EXPECT_FALSE(fs::exists(folder / "out.exr"));
}

TEST_F(BadDevice, FailingBuildShowsTheLog) {
    put("scene.toml", small_scene());
    const ProgramResult result =
        run(tiny_render, "RERADIANT_CACHE=cache POCL_EXTRA_BUILD_FLAGS=-DPI_REAL=nonsense");
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    EXPECT_NE(result.errors.find("does not build on"), std::string::npos) << result.errors;
    EXPECT_FALSE(fs::exists(folder / "out.exr"));
}

TEST_F(BadDevice, NoDeviceSaysWhatToInstall) {
    expect_failure(1, "check", "no OpenCL device was found", "OCL_ICD_VENDORS=/nowhere");
}

TEST_F(BadDevice, Case42CacheThatCannotBeMadeFallsBack) {
    put("scene.toml", small_scene());
    EXPECT_EQ(run(tiny_render, "RERADIANT_CACHE=/proc/none HOME=/proc/none").exit_code, 0);
}

/// Cuts every file of PoCL's cache with this ending to `kept` bytes; returns how many there were.
int damage(const fs::path& cache, const std::string& ending, std::uintmax_t kept) {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(cache))
        if (entry.is_regular_file() && entry.path().extension() == ending) {
            fs::resize_file(entry.path(), std::min(kept, fs::file_size(entry.path())));
            ++count;
        }
    return count;
}

TEST_F(BadDevice, Case40DamagedDriverCacheIsDiscardedAfterItCrashed) {
    put("scene.toml", small_scene());
    const std::string own_cache = "RERADIANT_CACHE=cache";
    ASSERT_EQ(run(tiny_render, own_cache).exit_code, 0);
    for (const std::string ending : {".so", ".bc"})
        for (const std::uintmax_t kept : {0, 1000}) {
            ASSERT_GT(damage(folder / "cache" / "pocl", ending, kept), 0) << ending;
            const ProgramResult first = run(tiny_render, own_cache);
            if (first.exit_code == 0)
                continue; // the driver noticed
            const ProgramResult second = run(tiny_render, own_cache);
            EXPECT_EQ(second.exit_code, 0) << ending << ' ' << kept << ": " << second.errors;
        }
}

} // namespace
} // namespace reradiant
