#pragma once

#include "host/device/buffer.h"
#include "host/device/opencl_device.h"
#include "host/device/program.h"
#include "tests/support/first_device.h"

#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace reradiant::test {

/// The program of probes.cl with every feature on and four vectors of lanes.
const cl::Program& probes();

/// Runs a probe over `input` and returns `outputs` floats for each of `count` items. Further
/// arguments follow the count.
template <typename... Arguments>
std::vector<float> run_probe(const char* name, const std::vector<float>& input, std::size_t count,
                             std::size_t outputs, const Arguments&... arguments) {
    const DeviceArray<float> in(device(), std::span<const float>(input));
    const DeviceArray<float> out(device(), count * outputs);
    Kernel kernel(probes(), name, 16);
    kernel.bind(in.buffer(), out.buffer(), static_cast<cl_uint>(count), arguments...);
    kernel.launch(device(), count);
    const auto mapped = out.map(CL_MAP_READ, 0, count * outputs);
    return {mapped.span().begin(), mapped.span().end()};
}

/// Uniform numbers and directions in single precision, reproducible.
class Source {
public:
    explicit Source(unsigned seed) : engine_(seed) {}
    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(engine_);
    }
    /// Appends a unit vector of the upper hemisphere, often near grazing.
    void push_direction(std::vector<float>& values) {
        const double z = uniform(0, 1) < 0.2 ? std::pow(10.0, uniform(-6, 0)) : uniform(1e-6, 1);
        const double phi = uniform(0, 6.283185307), s = std::sqrt((1 - z) * (1 + z));
        for (const double v : {s * std::cos(phi), s * std::sin(phi), z})
            values.push_back(static_cast<float>(v));
    }

private:
    std::mt19937_64 engine_;
};

/// |a - b| / max(|b|, floor)
double relative_difference(double a, double b, double floor);

} // namespace reradiant::test
