#include "tests/kernels/probe.h"
#include "host/device/opencl_device.h"

#include <algorithm>

namespace reradiant::test {

const cl::Program& probes() {
    static const cl::Program program =
        build_program(device(), "tests/kernels/probes.cl", {{"CHUNKS", 4}, {"LOBES", 1}});
    return program;
}

double relative_difference(double a, double b, double floor) {
    return std::abs(a - b) / std::max(std::abs(b), floor);
}

} // namespace reradiant::test
