#include "host/device/buffer.h"
#include "kernels/core/sequence.h"
#include "kernels/core/wavelength.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace reradiant {
namespace {

using namespace test;
using kernels::NumberBlock;
using kernels::Random4;
using kernels::sequence_block;

TEST(KernelSequence, DeviceAndHostGiveTheSameBits) {
    const std::size_t count = 10000;
    const std::vector<float> found = run_probe("probe_sequence", {0.0f}, count, 4);
    for (std::uint32_t i = 0; i < count; ++i) {
        const NumberBlock r = sequence_block(i / 7u, i, i % 9u, 42u);
        EXPECT_EQ(static_cast<double>(found[4 * i]), r.a);
        EXPECT_EQ(static_cast<double>(found[4 * i + 1]), r.b);
        EXPECT_EQ(static_cast<double>(found[4 * i + 2]), r.c);
        EXPECT_EQ(static_cast<double>(found[4 * i + 3]), r.d);
    }
}

using Point = std::array<double, 2>;

/// Every box of 2^-m x 2^-(k - m) that tiles the square holds one of 2^k points.
void expect_one_in_every_elementary_box(const std::vector<Point>& points) {
    const int k = static_cast<int>(std::lround(std::log2(points.size())));
    for (int m = 0; m <= k; ++m) {
        std::set<std::pair<int, int>> boxes;
        for (const Point& p : points)
            boxes.emplace(static_cast<int>(p[0] * (1 << m)),
                          static_cast<int>(p[1] * (1 << (k - m))));
        EXPECT_EQ(boxes.size(), points.size()) << "2^" << m << " columns of 2^" << k;
    }
}

TEST(KernelSequence, SixteenPathsAtOnceHaveTheNumbersOfEach) {
    constexpr std::size_t paths = 16 * 100;
    Kernel kernel(build_program(device(), "tests/kernels/together.cl", {{"PATHS_TOGETHER", 16}}),
                  "together", 4);
    DeviceArray<float> numbers(device(), 8 * paths);
    DeviceArray<std::uint32_t> phases(device(), paths);
    kernel.bind(numbers.buffer(), phases.buffer());
    kernel.launch(device(), paths / 16);
    const auto found = numbers.map(CL_MAP_READ, 0, 8 * paths);
    const auto phase = phases.map(CL_MAP_READ, 0, paths);
    for (std::uint32_t i = 0; i < paths; ++i) {
        const NumberBlock u = kernels::path_numbers(i / 7u, i, 3u, 7u, 42u);
        const NumberBlock v = kernels::path_numbers(i / 7u, i, 8u, 7u, 42u);
        const std::array expected = {u.a, u.b, u.c, u.d, v.a, v.b, v.c, v.d};
        for (std::size_t k = 0; k < 8; ++k)
            ASSERT_EQ(found.span()[8 * i + k], expected[k]) << "path " << i << ", number " << k;
        ASSERT_EQ(phase.span()[i], kernels::wavelength_phases(i / 7u, i, 64u, 42u)) << i;
    }
}

TEST(KernelSequence, PairsOfEitherHalfAreNets) {
    for (const std::uint32_t pixel : {0u, 12345u})
        for (const std::uint32_t dimension : {0u, 3u})
            for (const std::uint32_t half : {0u, 1u})
                for (const std::uint32_t first : {0u, 64u}) {
                    std::vector<Point> bc, ad;
                    for (std::uint32_t i = first; i < first + 64u; ++i) {
                        const NumberBlock r = sequence_block(pixel, 2u * i + half, dimension, 1u);
                        bc.push_back({r.b, r.c});
                        ad.push_back({r.a, r.d});
                    }
                    expect_one_in_every_elementary_box(bc);
                    expect_one_in_every_elementary_box(ad);
                }
}

/// The numbers of one sample are independent of each other, of other blocks, other pixels and the
/// other half: over pixels, every pair fills the square evenly. 255 degrees of freedom; the bound
/// is mean + 4.75 sd + 12, about 1e-6.
TEST(KernelSequence, DifferentNumbersAreIndependentOverPixels) {
    const auto pairs = [](std::uint32_t pixel) {
        const NumberBlock r = sequence_block(pixel, 6u, 1u, 0u),
                          other = sequence_block(pixel, 6u, 2u, 0u);
        const NumberBlock half = sequence_block(pixel, 7u, 1u, 0u),
                          next = sequence_block(pixel + 1u, 6u, 1u, 0u);
        return std::vector<Point>{{r.a, r.b},     {r.a, r.c},     {r.a, r.d},     {r.b, r.c},
                                  {r.b, r.d},     {r.c, r.d},     {r.a, other.a}, {r.b, other.b},
                                  {r.c, other.c}, {r.d, other.d}, {r.a, half.a},  {r.b, half.b},
                                  {r.b, next.b},  {r.c, half.c},  {r.a, next.a}};
    };
    const std::uint32_t count = 1u << 16;
    std::vector<std::vector<int>> cells(pairs(0).size(), std::vector<int>(256, 0));
    for (std::uint32_t pixel = 0; pixel < count; ++pixel) {
        const std::vector<Point> found = pairs(pixel);
        for (std::size_t p = 0; p < found.size(); ++p)
            ++cells[p][static_cast<std::size_t>(found[p][0] * 16) * 16 +
                       static_cast<std::size_t>(found[p][1] * 16)];
    }
    for (std::size_t p = 0; p < cells.size(); ++p) {
        double chi = 0.0;
        for (const int cell : cells[p])
            chi += (cell - count / 256.0) * (cell - count / 256.0) / (count / 256.0);
        EXPECT_LT(chi, 255 + 4.75 * std::sqrt(510.0) + 12) << "pair " << p;
    }
}

/// The numbers of ten bounces, each against each other over a pixel's samples: no period shows as
/// full and empty bins. Under nested scrambling the product of bit l of two numbers is the same for
/// 2^(l+1) samples, so chi-square is a sum of 64, 16, 4 and 1 squares of weight 2, 4, 8 and 16: its
/// mean is 240, and 1166 is passed with a probability below 3160 e^-20 (Laurent and Massart 2000,
/// lemma 1, x = 20). Numbers that repeat have a million.
TEST(KernelSequence, Case34TenBouncesOf65536SamplesLeaveNoPeriodicBins) {
    constexpr std::uint32_t samples = 1u << 16, bounces = 10;
    constexpr std::size_t dimensions = 8 * bounces;
    std::vector<std::array<std::uint8_t, dimensions>> bins(samples);
    for (std::uint32_t sample = 0; sample < samples; ++sample)
        for (std::uint32_t bounce = 0; bounce < bounces; ++bounce) {
            const NumberBlock u = kernels::path_numbers(77u, sample, 2u * bounce, 2u * bounces, 5u),
                              v = kernels::path_numbers(77u, sample, 2u * bounce + 1u, 2u * bounces,
                                                        5u);
            const std::array numbers = {u.a, u.b, u.c, u.d, v.a, v.b, v.c, v.d};
            for (std::size_t k = 0; k < 8; ++k)
                bins[sample][8 * bounce + k] = static_cast<std::uint8_t>(numbers[k] * 16);
        }
    for (std::size_t x = 0; x < dimensions; ++x)
        for (std::size_t y = 0; y < x; ++y) {
            std::array<int, 256> counts{};
            for (const auto& sample : bins)
                ++counts[sample[x] * 16u + sample[y]];
            double chi = 0.0;
            for (const int count : counts)
                chi += (count - samples / 256.0) * (count - samples / 256.0) / (samples / 256.0);
            EXPECT_LT(chi, 1166) << "numbers " << x << " and " << y;
        }
}

/// Means of a smooth function over a pixel's samples come close to its integral far faster than
/// those of independent numbers, whose error would be 1 / sqrt(n) of the spread.
TEST(KernelSequence, IntegratesSmoothFunctionsBetterThanChance) {
    for (const std::uint32_t samples : {16u, 64u, 256u}) {
        double squares = 0.0;
        constexpr std::uint32_t pixels = 200;
        for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
            double sum = 0.0;
            for (std::uint32_t i = 0; i < samples; ++i) {
                const NumberBlock r = sequence_block(pixel, i, 2u, 9u);
                sum += std::exp(r.b) * std::cos(r.c);
            }
            const double error = sum / samples - (std::exp(1.0) - 1.0) * std::sin(1.0);
            squares += error * error / pixels;
        }
        const double independent = 0.52 / std::sqrt(samples); // spread of exp(b) cos(c): 0.52
        EXPECT_LT(std::sqrt(squares), independent * 2.0 / std::sqrt(samples / 2.0)) << samples;
    }
}

} // namespace
} // namespace reradiant
