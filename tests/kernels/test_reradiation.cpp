#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace reradiant {
namespace {

using namespace test;

constexpr int lanes = 64;

std::vector<float> random_values(std::size_t count, unsigned seed) {
    Source source(seed);
    std::vector<float> values(count);
    for (float& value : values)
        value = static_cast<float>(source.uniform(0, 1));
    return values;
}

TEST(KernelReradiation, FactoredFormIsItsMaskedMatrix) {
    for (const unsigned rank : {1u, 2u, 4u}) {
        const std::vector<float> factors = random_values(2 * rank * lanes, rank);
        const std::vector<float> input = random_values(3 * lanes, 99);
        const DeviceArray<float> buffer(device(), std::span<const float>(factors));
        const std::vector<float> found =
            run_probe("probe_factored", input, 3, lanes, buffer.buffer(), rank);
        for (int item = 0; item < 3; ++item)
            for (int o = 0; o < lanes; ++o) {
                double expected = 0.0;
                for (unsigned k = 0; k < rank; ++k)
                    for (int i = 0; i < o; ++i)
                        expected +=
                            static_cast<double>(factors[k * lanes + static_cast<unsigned>(o)]) *
                            static_cast<double>(
                                factors[(rank + k) * lanes + static_cast<unsigned>(i)]) *
                            static_cast<double>(input[static_cast<std::size_t>(item * lanes + i)]);
                // 64 additions in single precision.
                EXPECT_NEAR(found[static_cast<std::size_t>(item * lanes + o)], expected,
                            1e-6 * expected + 1e-7);
            }
    }
}

TEST(KernelReradiation, DenseFormIsItsMatrix) {
    const std::vector<float> matrix = random_values(lanes * lanes, 5);
    const std::vector<float> input = random_values(lanes, 6);
    const DeviceArray<float> buffer(device(), std::span<const float>(matrix));
    const std::vector<float> found = run_probe("probe_dense", input, 1, lanes, buffer.buffer());
    for (int o = 0; o < lanes; ++o) {
        double expected = 0.0;
        for (int i = 0; i < lanes; ++i)
            expected += static_cast<double>(matrix[static_cast<std::size_t>(i * lanes + o)]) *
                        static_cast<double>(input[static_cast<std::size_t>(i)]);
        EXPECT_NEAR(found[static_cast<std::size_t>(o)], expected, 2e-6 * expected);
    }
}

} // namespace
} // namespace reradiant
