#include "host/check/check.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"
#include "tests/support/first_device.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace reradiant {
namespace {

using test::device;

namespace fs = std::filesystem;

CheckReport checked(const std::string& only, std::size_t samples = 2000, bool in_double = false) {
    CheckOptions options;
    options.only = only;
    options.samples = samples;
    options.in_double = in_double;
    return check_device(device(), options);
}

std::string failures(const CheckReport& report) {
    std::string text;
    for (const FunctionReport& function : report.functions)
        for (const std::string& failure : function.failures)
            text += function.name + ": " + failure + "\n";
    return text;
}

/// The kernels' folder with one file changed, as RERADIANT_DATA while it lives.
class ChangedKernel {
public:
    ChangedKernel(const std::string& file, const std::string& from, const std::string& to)
        : folder_(fs::temp_directory_path() / ("reradiant-changed-" + std::to_string(::getpid()))) {
        fs::create_directories(folder_);
        fs::copy(data_directory() / "kernels", folder_ / "kernels", fs::copy_options::recursive);
        std::stringstream text;
        text << std::ifstream(folder_ / file).rdbuf();
        std::string source = text.str();
        const std::size_t place = source.find(from);
        EXPECT_NE(place, std::string::npos) << from;
        std::ofstream(folder_ / file) << source.replace(place, from.size(), to);
        ::setenv("RERADIANT_DATA", folder_.c_str(), 1);
    }
    ~ChangedKernel() {
        ::unsetenv("RERADIANT_DATA");
        fs::remove_all(folder_);
    }
    ChangedKernel(const ChangedKernel&) = delete;
    ChangedKernel& operator=(const ChangedKernel&) = delete;

private:
    fs::path folder_;
};

constexpr const char* fresnel_sum = "r = REAL(0.5) * (s * s + p * p);";

TEST(Check, EveryFunctionPassesOnThisDevice) {
    const CheckReport report = checked("", test::is_full_run() ? 1000000 : 2000);
    EXPECT_TRUE(report.passed()) << failures(report);
    EXPECT_GT(report.functions.size(), 60U);
    for (const FunctionReport& function : report.functions) {
        EXPECT_GT(function.nanoseconds, 0.0) << function.name;
        EXPECT_LE(function.of_budget, 1.0) << function.name;
    }
}

TEST(Check, FindsAFormulaThatIsOffByOnePartInAThousand) {
    const ChangedKernel changed("kernels/scatter/fresnel.h", fresnel_sum,
                                "r = REAL(0.5005) * (s * s + p * p);");
    EXPECT_FALSE(checked("fresnel_dielectric").passed());
}

TEST(Check, FindsAnUnstableForm) {
    // case 8: 1 - z^2 instead of x^2 + y^2
    const ChangedKernel changed("kernels/scatter/microfacet.h",
                                "real sin2 = h.x * h.x + h.y * h.y;",
                                "real sin2 = REAL(1.0) - h.z * h.z;");
    EXPECT_FALSE(checked("microfacet_d ggx").passed());
}

TEST(Check, Case44FindsANanWhereTheTwinIsFinite) {
    const ChangedKernel changed("kernels/scatter/fresnel.h",
                                "return r < REAL(1.0) ? r : REAL(1.0);",
                                "return (g2 - g2) / (g2 - g2);");
    const CheckReport report = checked("fresnel_dielectric");
    ASSERT_FALSE(report.passed());
    EXPECT_GT(report.functions.front().not_finite, 0U);
}

TEST(Check, RegressionFileNoticesWhatMoved) {
    const fs::path file =
        fs::temp_directory_path() / ("reradiant-check-" + std::to_string(::getpid()) + ".json");
    save_results(file, device(), checked("fresnel"));
    CheckReport same = checked("fresnel");
    const SavedResults saved = read_saved_results(file);
    compare_results(saved, same);
    EXPECT_TRUE(same.passed()) << failures(same);
    {
        const ChangedKernel changed("kernels/scatter/fresnel.h", fresnel_sum,
                                    "r = REAL(0.5005) * (s * s + p * p);");
        CheckReport moved = checked("fresnel_dielectric");
        moved.functions.front().failures.clear(); // which do not come from the saved file
        compare_results(saved, moved);
        EXPECT_FALSE(moved.passed());
    }
    CheckReport unknown = checked("random_unit");
    compare_results(saved, unknown);
    EXPECT_FALSE(unknown.passed()) << "the file does not hold that function";
    fs::remove(file);
}

TEST(Check, RegressionFileMustBeOne) {
    EXPECT_THROW(read_saved_results("/nowhere.json"), Error);
    EXPECT_THROW(read_saved_results(data_directory() / "kernels/core/random.h"), Error);
}

TEST(Check, DoubleKernelsAgreeWithTheTwinToTheirOwnPrecision) {
    if (!device().info().has_double)
        GTEST_SKIP() << "the device has no double precision";
    for (const FunctionReport& function : checked("fresnel", 2000, true).functions) {
        EXPECT_GT(function.double_nanoseconds, 0.0);
        EXPECT_LT(function.double_max_relative, 1e-9) << function.name;
    }
}

TEST(Check, UnknownFunctionIsBadInput) {
    try {
        checked("no such function");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2);
    }
}

} // namespace
} // namespace reradiant
