// The film kernel itself: what it refuses, and that its sums do not stop growing.
#include "host/device/opencl_device.h"
#include "kernels/stages/arguments.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

#include <limits>

namespace reradiant {
namespace {

using namespace test;

constexpr std::size_t lanes = 16, rows = 3, statistics_count = FILM_STATISTICS;

/// One pixel of 16 lanes to which radiances are added, all lanes of a path alike but one.
class OnePixel {
public:
    OnePixel()
        : program_(build_program(device(), "kernels/film.cl",
                                 {{"CHUNKS", 1},
                                  {"FILM_CHUNKS", 1},
                                  {"FEATURE_SCATTER", 0},
                                  {"FEATURE_BAND_VARIANCE", 0}})),
          sums_(rows * lanes, 0.0f), statistics_(statistics_count, 0.0f) {}

    void start_at(float sum) {
        for (std::size_t i = 0; i < lanes; ++i)
            sums_[i] = sum;
    }
    void add(const std::vector<float>& added) {
        const std::size_t samples = added.size() / lanes;
        const DeviceArray<float> sums(device(), std::span<const float>(sums_));
        const DeviceArray<float> statistics(device(), std::span<const float>(statistics_));
        const DeviceArray<float> radiance(device(), std::span<const float>(added));
        const std::vector<PathState> states(samples, PathState{});
        const DeviceArray<PathState> paths(device(), std::span<const PathState>(states));
        const DeviceArray<std::int32_t> film_bands(device(), lanes);
        const std::vector<float> ones(2 * lanes, 1.0f);
        const DeviceArray<float> film_weights(device(), std::span<const float>(ones));
        const DeviceArray<float>& y_weights = film_weights;
        const BatchRecord batch{0, 0, 1, 0, static_cast<std::uint32_t>(samples), 0};
        Kernel kernel(program_, "film", 8);
#define ARRAY(type, name) (name).buffer()
#define RECORD(type, name) name
        kernel.bind(FILM_ARGUMENTS(ARRAY, ARRAY, ARRAY, RECORD));
#undef ARRAY
#undef RECORD
        kernel.launch(device(), 1);
        const auto mapped = sums.map(CL_MAP_READ, 0, rows * lanes);
        sums_.assign(mapped.span().begin(), mapped.span().end());
        const auto counted = statistics.map(CL_MAP_READ, 0, statistics_count);
        statistics_.assign(counted.span().begin(), counted.span().end());
    }
    /// Returns the sum as the host reads it: without its compensation.
    double sum(std::size_t lane) const {
        return static_cast<double>(sums_[lane]) - static_cast<double>(sums_[lanes + lane]);
    }
    float refused() const {
        return statistics_[4];
    }

private:
    cl::Program program_;
    std::vector<float> sums_, statistics_;
};

TEST(KernelFilm, Case44SamplesWithNanOrInfinityAreRefusedAndCounted) {
    OnePixel pixel;
    const float bad[] = {
        std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN(),
        std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    std::vector<float> radiance(6 * lanes, 1.0f);
    for (std::size_t path = 0; path < std::size(bad); ++path)
        radiance[path * lanes + 3 * path] = bad[path];
    pixel.add(radiance);
    EXPECT_EQ(pixel.refused(), 4.0f);
    for (std::size_t lane = 0; lane < lanes; ++lane)
        EXPECT_EQ(pixel.sum(lane), 2.0) << lane;
}

TEST(KernelFilm, Case59SumsGrowBeyondTwoToThe24) {
    OnePixel pixel;
    pixel.start_at(0x1p24f);
    constexpr std::size_t paths = 4097;
    pixel.add(std::vector<float>(paths * lanes, 1.0f));
    for (std::size_t lane = 0; lane < lanes; ++lane)
        EXPECT_EQ(pixel.sum(lane), 0x1p24 + static_cast<double>(paths))
            << "a plain float sum stays at 2^24";
}

} // namespace
} // namespace reradiant
