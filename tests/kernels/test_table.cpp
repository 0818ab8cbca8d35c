#include "kernels/core/table.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace reradiant {
namespace {

using namespace test;

TEST(KernelTable, StencilReproducesCubicsInTheSquareRootOfTheCosine) {
    Source source(3);
    std::vector<float> input = {0.0f, 1.0f, 1e-8f, 0.999999f};
    for (int i = 0; i < 10000; ++i)
        input.push_back(static_cast<float>(source.uniform(0, 1)));
    const std::vector<float> found = run_probe("probe_table", input, input.size(), 5);
    const auto cubic = [](double u) { return 0.3 + u * (1.1 - u * (2.0 - 0.7 * u)); };
    for (std::size_t i = 0; i < input.size(); ++i) {
        double value = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double u = (found[5 * i] + static_cast<double>(k)) / (TABLE_NODES - 1);
            value += static_cast<double>(found[5 * i + 1 + k]) * cubic(u);
        }
        EXPECT_NEAR(value, cubic(std::sqrt(static_cast<double>(input[i]))), 2e-6) << input[i];
        EXPECT_LE(found[5 * i] + 3.0f, static_cast<float>(TABLE_NODES - 1));
    }
}

TEST(KernelTable, TransmissionOfGlassInterpolatesToAMillionth) {
    // T = 4ab / (a + b)^2 averaged over polarisations: the function the tables hold.
    const auto transmission = [](double c) {
        const double t = std::sqrt(2.25 - 1.0 + c * c);
        const double rs = (c - t) / (c + t), rp = (2.25 * c - t) / (2.25 * c + t);
        return 1.0 - 0.5 * (rs * rs + rp * rp);
    };
    for (int i = 1; i <= 1000; ++i) {
        const double c = i / 1000.0;
        const kernels::TableStencil s = kernels::table_stencil(c);
        double value = 0.0;
        const double weights[] = {s.w0, s.w1, s.w2, s.w3};
        for (unsigned k = 0; k < 4; ++k) {
            const double u = (s.node + k) / static_cast<double>(TABLE_NODES - 1);
            value += weights[k] * transmission(u * u);
        }
        EXPECT_NEAR(value, transmission(c), 1e-6) << c;
    }
}

TEST(KernelTable, SearchCountsTheNumbersThatAreNotAbove) {
    Source source(5);
    for (std::size_t count = 0; count < 20; ++count) {
        std::vector<float> numbers;
        for (std::size_t i = 0; i < count; ++i) // many are equal
            numbers.push_back(std::floor(static_cast<float>(source.uniform(0, 8))) / 8.0f);
        std::sort(numbers.begin(), numbers.end());
        std::vector<float> apart(3 * count + 1, -1.0f);
        for (std::size_t i = 0; i < count; ++i)
            apart[3 * i] = numbers[i];
        for (int i = -1; i <= 17; ++i) {
            const double x = i / 16.0;
            const auto expected = std::upper_bound(numbers.begin(), numbers.end(), x);
            EXPECT_EQ(kernels::table_search(apart.data(), static_cast<unsigned>(count), 3, x),
                      expected - numbers.begin())
                << count << " numbers, " << x;
        }
    }
}

} // namespace
} // namespace reradiant
