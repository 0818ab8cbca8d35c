#include "host/device/source.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

TEST(KernelSource, HeadersStandInPlaceOnceWithTheirNames) {
    const std::string source = kernel_source(data_directory(), "kernels/gather.cl", {{"LOBES", 3}});
    EXPECT_EQ(source.rfind("#define LOBES 3\n", 0), 0u);
    const std::string marker = "#line 1 \"kernels/core/portable.h\"";
    const std::size_t first = source.find(marker);
    ASSERT_NE(first, std::string::npos);
    EXPECT_EQ(source.find(marker, first + 1), std::string::npos);
    EXPECT_EQ(source.find("#include \"kernels/"), std::string::npos);
}

TEST(KernelSource, MissingFileIsNamed) {
    try {
        kernel_source(data_directory(), "kernels/nothing.cl", {});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 1);
        EXPECT_NE(std::string(error.what()).find("nothing.cl"), std::string::npos);
    }
}

TEST(KernelSource, DigestDependsOnEveryCharacter) {
    EXPECT_NE(text_digest("a"), text_digest("b"));
    EXPECT_EQ(text_digest("").size(), 16u);
}

} // namespace
} // namespace reradiant
