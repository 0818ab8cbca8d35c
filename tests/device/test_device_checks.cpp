#include "host/device/device_checks.h"
#include "tests/support/scratch_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace reradiant {
namespace {

class DeviceChecks : public ::testing::Test {
protected:
    DeviceChecks() { ::setenv("XDG_CACHE_HOME", (folder / "").c_str(), 1); }
    ~DeviceChecks() override { ::unsetenv("XDG_CACHE_HOME"); }

    static DeviceInfo device(const std::string& driver) {
        DeviceInfo info;
        info.platform = "A platform";
        info.name = "A device";
        info.driver = driver;
        info.version = "OpenCL 1.2";
        return info;
    }

    const test::TemporaryFolder folder;
};

TEST_F(DeviceChecks, ResultsAreThoseOfADriver) {
    EXPECT_EQ(device_check(device("1")), DeviceCheck::Never);
    remember_device_check(device("1"), true);
    EXPECT_EQ(device_check(device("1")), DeviceCheck::Passed);
    EXPECT_EQ(device_check(device("2")), DeviceCheck::Never) << "another driver, another device";
    remember_device_check(device("1"), false);
    EXPECT_EQ(device_check(device("1")), DeviceCheck::Failed);
}

TEST_F(DeviceChecks, ADeviceThatWasNeverCheckedIsWarnedOfOnce) {
    EXPECT_NE(unchecked_device_warning(device("1")).find("reradiant check"), std::string::npos);
    EXPECT_EQ(unchecked_device_warning(device("1")), "");
    EXPECT_NE(unchecked_device_warning(device("2")), "");
    EXPECT_EQ(device_check(device("1")), DeviceCheck::Never) << "a warning is no check";
    remember_device_check(device("1"), false);
    EXPECT_NE(unchecked_device_warning(device("1")), "");
    EXPECT_NE(unchecked_device_warning(device("1")), "") << "a failure is always worth saying";
    remember_device_check(device("1"), true);
    EXPECT_EQ(unchecked_device_warning(device("1")), "");
}

TEST_F(DeviceChecks, DriversOfTheTestsAreNotWarnedOf) {
    DeviceInfo pocl = device("3.1+debian");
    pocl.platform = "Portable Computing Language";
    EXPECT_EQ(device_check(pocl), DeviceCheck::OfProject);
    EXPECT_EQ(unchecked_device_warning(pocl), "");
}

} // namespace
} // namespace reradiant
