#include "kernels/scatter/microfacet.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace reradiant {
namespace {

using namespace test;
using kernels::vec3;

struct Deviations {
    std::vector<double> distribution, reflection, pdf;
};

Deviations deviations(int distribution, double alpha_from, double alpha_to) {
    Source source(7);
    std::vector<float> input;
    constexpr std::size_t count = 100000;
    for (std::size_t i = 0; i < count; ++i) {
        input.push_back(static_cast<float>(distribution));
        input.push_back(
            static_cast<float>(std::exp(source.uniform(std::log(alpha_from), std::log(alpha_to)))));
        source.push_direction(input);
        source.push_direction(input);
        input.push_back(static_cast<float>(source.uniform(0, 0.9999)));
        input.push_back(static_cast<float>(source.uniform(0, 0.9999)));
    }
    const std::vector<float> found = run_probe("probe_microfacet", input, count, 6);
    Deviations result;
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = input.data() + 10 * i;
        const auto wi = vec3(p[2], p[3], p[4]), wo = vec3(p[5], p[6], p[7]);
        const auto h = kernels::vec3_normalise(kernels::vec3_add(wi, wo));
        for (std::size_t k = 0; k < 6; ++k)
            EXPECT_TRUE(std::isfinite(found[6 * i + k])) << "output " << k << ", item " << i;
        // Values below 1e-4 of a Lambertian surface's cannot be seen.
        const double floor = 1e-4;
        result.distribution.push_back(
            relative_difference(found[6 * i], kernels::microfacet_d(distribution, p[1], h), floor));
        result.reflection.push_back(relative_difference(
            found[6 * i + 1], kernels::microfacet_reflection(distribution, p[1], wi, wo), floor));
        result.pdf.push_back(relative_difference(
            found[6 * i + 2], kernels::microfacet_pdf(distribution, p[1], wo, h), floor));
        const double length = std::hypot(found[6 * i + 3], found[6 * i + 4], found[6 * i + 5]);
        EXPECT_NEAR(length, 1.0, 1e-5);
        EXPECT_GE(found[6 * i + 5], 0.0f);
    }
    for (auto* list : {&result.distribution, &result.reflection, &result.pdf})
        std::sort(list->begin(), list->end());
    return result;
}

/// 99.9 % of the inputs agree to the rounding of the half vector (its relative error, 1e-7, is
/// amplified by the lobe's slope, at most about 2 / alpha).
void expect_twin(int distribution, double alpha_from, double alpha_to) {
    const Deviations d = deviations(distribution, alpha_from, alpha_to);
    const std::size_t at = d.pdf.size() * 999 / 1000;
    const double budget = 4e-6 / alpha_from + 2e-5;
    EXPECT_LT(d.distribution[at], budget);
    EXPECT_LT(d.reflection[at], budget);
    EXPECT_LT(d.pdf[at], budget);
}

TEST(KernelMicrofacet, GgxMatchesDouble) {
    expect_twin(MICROFACET_GGX, 0.02, 1.0);
}
TEST(KernelMicrofacet, BeckmannMatchesDouble) {
    expect_twin(MICROFACET_BECKMANN, 0.02, 1.0);
}
TEST(KernelMicrofacet, BlinnMatchesDouble) {
    expect_twin(MICROFACET_BLINN, 0.02, 0.9);
}

TEST(KernelMicrofacet, Case08NarrowLobesStayFiniteAndRight) {
    expect_twin(MICROFACET_GGX, 1e-4, 1e-3);
    expect_twin(MICROFACET_BECKMANN, 1e-4, 1e-3);
    expect_twin(MICROFACET_BLINN, 1e-4, 1e-3);
}

} // namespace
} // namespace reradiant
