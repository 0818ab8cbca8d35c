#include "host/device/program.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"
#include "tests/support/first_device.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace reradiant {
namespace {

using test::device;

namespace fs = std::filesystem;

/// A cache of its own, so that what a test breaks is its own.
class ProgramCache : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("reradiant-cache-" + std::to_string(::getpid()) + "-" +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        device();
        ::setenv("RERADIANT_CACHE", folder_.c_str(), 1);
    }
    void TearDown() override {
        ::unsetenv("RERADIANT_CACHE");
        fs::remove_all(folder_);
    }
    BuildStatistics build() {
        BuildStatistics statistics;
        const Device anew(""); // which has loaded nothing
        build_program(anew, "kernels/generate.cl", {{"FEATURE_LENS", 0}}, &statistics);
        return statistics;
    }
    fs::path only_entry() {
        for (const auto& entry : fs::directory_iterator(folder_ / "programs"))
            return entry.path();
        return {};
    }
    fs::path folder_;
};

TEST_F(ProgramCache, Case43SecondBuildComesFromTheCache) {
    EXPECT_EQ(build().built, 1);
    EXPECT_EQ(build().from_cache, 1);
}

TEST_F(ProgramCache, DeviceLoadsAProgramOnce) {
    const Device opened("");
    const auto build_there = [&] {
        return build_program(opened, "kernels/generate.cl", {{"FEATURE_LENS", 0}})();
    };
    const cl_program first = build_there();
    fs::remove_all(folder_);
    EXPECT_EQ(build_there(), first);
    EXPECT_FALSE(fs::exists(folder_)) << "nothing was looked for on disk";
}

TEST_F(ProgramCache, Case41DamagedEntryIsRebuiltNeverLoaded) {
    build();
    const fs::path entry = only_entry();
    const auto size = fs::file_size(entry);
    for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{10}, size / 2, size - 1}) {
        fs::resize_file(entry, kept);
        EXPECT_EQ(build().built, 1) << "truncated to " << kept;
    }
    std::fstream stream(entry, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(size / 2));
    stream.put('\x5a');
    stream.close();
    EXPECT_EQ(build().built, 1) << "one byte changed";
    EXPECT_EQ(build().from_cache, 1) << "and it was written anew";
}

TEST_F(ProgramCache, FailedBuildShowsTheLogAndLeavesTheSource) {
    const fs::path data = folder_ / "data";
    fs::create_directories(data / "kernels");
    std::ofstream(data / "kernels" / "broken.cl") << "\n\n__kernel void broken() { nonsense; }\n";
    ::setenv("RERADIANT_DATA", data.c_str(), 1);
    try {
        build_program(device(), "kernels/broken.cl", {});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 1);
        const std::string text = error.what();
        EXPECT_NE(text.find("kernels/broken.cl:3"), std::string::npos) << text;
        EXPECT_NE(text.find("nonsense"), std::string::npos) << text;
    }
    ::unsetenv("RERADIANT_DATA");
    EXPECT_TRUE(fs::exists(folder_ / "failed-broken.cl"));
}

TEST(OpenDevice, UnknownNameListsWhatThereIs) {
    prepare_opencl(0);
    try {
        Device("no such device");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 1);
        EXPECT_NE(std::string(error.what()).find("0: "), std::string::npos);
    }
}

} // namespace
} // namespace reradiant
