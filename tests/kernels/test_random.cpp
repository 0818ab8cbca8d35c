#include "kernels/core/random.h"
#include "kernels/core/wavelength.h"
#include "tests/kernels/probe.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <set>

namespace reradiant {
namespace {

using namespace test;

TEST(KernelRandom, DeviceAndHostGiveTheSameBits) {
    const std::size_t count = 10000;
    const std::vector<float> found = run_probe("probe_random", {0.0f}, count, 4);
    for (std::uint32_t i = 0; i < count; ++i) {
        const kernels::Random4 r = kernels::random_4(i, i * 7u + 1u, i % 13u, 42u);
        EXPECT_EQ(static_cast<double>(found[4 * i]), r.a);
        EXPECT_EQ(static_cast<double>(found[4 * i + 1]), r.b);
        EXPECT_EQ(static_cast<double>(found[4 * i + 2]), r.c);
        EXPECT_EQ(static_cast<double>(found[4 * i + 3]), r.d);
    }
}

TEST(KernelRandom, Case02LargestBitsStayBelowOne) {
    EXPECT_LT(static_cast<float>(kernels::random_unit(0xffffffffu)), 1.0f);
    EXPECT_EQ(kernels::random_unit(0u), 0.0);
}

TEST(KernelRandom, NeighbouringCountersFillTheSquareEvenly) {
    // Chi-square over 16 x 16 cells of (first, second) numbers of neighbouring samples; 255
    // degrees of freedom, bound at about 1e-6: mean + 4.75 sd + 12.
    std::vector<int> cells(256, 0);
    constexpr int count = 1 << 16;
    for (std::uint32_t i = 0; i < count; ++i) {
        const kernels::Random4 r = kernels::random_4(i % 256, i / 256, 3u, 0u);
        ++cells[static_cast<std::size_t>(r.a * 16) * 16 + static_cast<std::size_t>(r.b * 16)];
    }
    const double chi = test::chi_square(cells, count / 256.0);
    EXPECT_LT(chi, 255 + 4.75 * std::sqrt(510.0) + 12);
    EXPECT_GT(chi, 255 - 4.75 * std::sqrt(510.0));
}

TEST(KernelWavelength, PhasesAreStratifiedInBothHalvesWhichAreIndependent) {
    int together = 0;
    for (std::uint32_t pixel = 0; pixel < 800; ++pixel)
        together += kernels::wavelength_phases(pixel, 0u, 8u, 5u) ==
                    kernels::wavelength_phases(pixel, 1u, 8u, 5u);
    EXPECT_NEAR(together, 100, 50); // an eighth; 9.4 is one standard deviation
    for (const std::uint32_t pixel : {0u, 17u, 4711u}) {
        std::set<std::uint32_t> even, odd;
        for (std::uint32_t sample = 0; sample < 16; ++sample)
            (sample % 2 ? odd : even).insert(kernels::wavelength_phases(pixel, sample, 8u, 5u));
        EXPECT_EQ(even.size(), 8u);
        EXPECT_EQ(odd.size(), 8u);
        std::set<std::uint32_t> quarters; // few samples spread over many phases
        for (std::uint32_t sample = 0; sample < 8; sample += 2)
            quarters.insert(kernels::wavelength_phases(pixel, sample, 512u, 5u) / 128u);
        EXPECT_EQ(quarters.size(), 4u);
    }
}

} // namespace
} // namespace reradiant
