// These tests are of what a device refuses, and show that the cause is named before or after it
// does.
#include "host/device/buffer.h"
#include "host/device/opencl_device.h"
#include "host/device/program.h"
#include "reradiant/error.h"
#include "tests/support/first_device.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace reradiant {
namespace {

using test::device;

template <typename Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 1);
        return error.what();
    }
    return "no error";
}

const cl::Program& generate_program() {
    static const cl::Program program =
        build_program(device(), "kernels/generate.cl", {{"FEATURE_LENS", 0}});
    return program;
}

TEST(DeviceLimits, Case37GroupsAreNeverLargerThanTheDeviceAllows) {
    const Kernel kernel(generate_program(), "generate", std::size_t{1} << 20U);
    EXPECT_LE(kernel.local_size(), device().info().max_work_group);
    const Kernel small(generate_program(), "generate", 8);
    EXPECT_EQ(small.local_size(), 8U) << "what was asked for, where it can be had";
}

TEST(DeviceLimits, Case39BuffersAreTheDriversOwnAndAligned) {
    for (const std::size_t count : {1U, 3U, 1000U, 100001U}) {
        const DeviceArray<float> array(device(), count);
        const auto mapped = array.map(CL_MAP_READ, 0, count);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(mapped.span().data()) % 128, 0U);
        // over memory that is given only where that is the driver's own (SVM), aligned for any type
        cl_bool is_shared = CL_FALSE;
        if (array.buffer().getInfo<CL_MEM_FLAGS>() &
            static_cast<cl_mem_flags>(CL_MEM_USE_HOST_PTR)) {
            ASSERT_EQ(clGetMemObjectInfo(array.buffer()(), CL_MEM_USES_SVM_POINTER,
                                         sizeof(is_shared), &is_shared, nullptr),
                      CL_SUCCESS);
            EXPECT_EQ(is_shared, CL_TRUE);
        }
        EXPECT_EQ(is_shared == CL_TRUE, device().info().shares_memory);
    }
}

TEST(DeviceLimits, DoubleIsRefusedWhereThereIsNone) {
    DeviceInfo single;
    single.name = "small";
    try {
        check_double(single);
        ADD_FAILURE() << "double was not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2);
        EXPECT_NE(std::string(error.what()).find("'small' has no double"), std::string::npos);
    }
    single.has_double = true;
    EXPECT_NO_THROW(check_double(single));
}

TEST(DeviceLimits, Case42AllocationBeyondTheLimitNamesIt) {
    const std::size_t most = device().info().max_allocation_bytes;
    const std::string text =
        error_of([&] { DeviceArray<float>(device(), most / sizeof(float) + 1); });
    EXPECT_NE(text.find(std::to_string(most)), std::string::npos) << text;
    EXPECT_NE(text.find("make the film smaller"), std::string::npos) << text;
}

TEST(DeviceLimits, Case42RefusedLaunchesNameTheCause) {
    const cl::Kernel kernel(generate_program(), "generate");
    for (const auto& [global, local] :
         {std::pair<std::size_t, std::size_t>{100, 64}, {1U << 20U, 1U << 20U}}) {
        const std::string text = error_of([&, g = global, l = local] {
            opencl_checked("a launch", [&] {
                device().opencl().queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(g),
                                                             cl::NDRange(l));
            });
        });
        EXPECT_NE(text.find("a launch failed"), std::string::npos) << text;
        EXPECT_NE(text.find("CL_INVALID_"), std::string::npos) << text;
    }
}

} // namespace
} // namespace reradiant
