#include "kernels/stack/layer_stack.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace reradiant {
namespace {

using namespace test;
using kernels::vec3;
using kernels::Vec3;

const std::vector<LayerRecord> layers = {{1.5f, 0.2f, MICROFACET_GGX, NO_INDEX, 0.0f, NO_INDEX},
                                         {1.2f, 0.0f, MICROFACET_GGX, NO_INDEX, 0.0f, NO_INDEX},
                                         {0.9f, 0.3f, MICROFACET_BLINN, NO_INDEX, 0.0f, NO_INDEX}};

TEST(KernelLayerStack, ModelAMatchesDouble) {
    Source source(13);
    std::vector<float> input;
    constexpr std::size_t count = 50000;
    for (std::size_t i = 0; i < 2 * count; ++i)
        source.push_direction(input);
    const DeviceArray<LayerRecord> buffer(device(), std::span<const LayerRecord>(layers));
    const std::vector<float> found =
        run_probe("probe_descend", input, count, 3, buffer.buffer(), 3u);
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = input.data() + 6 * i;
        const kernels::LayerDescent descent = kernels::model_a_descend(
            layers.data(), 3, nullptr, vec3(p[0], p[1], p[2]), vec3(p[3], p[4], p[5]));
        const double expected = descent.way_in * descent.way_out;
        EXPECT_LT(relative_difference(found[3 * i], expected, 1e-3), 1e-3) << i;
    }
}

TEST(KernelLayerStack, Case12HenyeyGreensteinKeepsItsDigitsNearOne) {
    Source source(19);
    std::vector<float> input;
    constexpr std::size_t count = 20000;
    for (std::size_t i = 0; i < count; ++i) {
        const double g = 1.0 - std::pow(10.0, source.uniform(-4.5, 0.3)); // -1 .. 0.99997
        const double bend = std::pow(10.0, source.uniform(-6.0, 0.3));    // 1 - cos
        input.push_back(static_cast<float>(std::max(g, -0.999)));
        input.push_back(static_cast<float>(i % 16 == 0 ? 1.0 : 1.0 - bend));
    }
    const std::vector<float> found = run_probe("probe_phase", input, count, 1);
    for (std::size_t i = 0; i < count; ++i) {
        const long double g = input[2 * i], c = input[2 * i + 1];
        const long double expected =
            (1 - g * g) / (12.566370614359172954L * std::pow(1 + g * g - 2 * g * c, 1.5L));
        // 1 - g, 1 - cos exact; some ten roundings and the divisions of OpenCL (2.5 ULP)
        EXPECT_LT(relative_difference(found[i], static_cast<double>(expected), 0.0), 1e-6)
            << input[2 * i] << ", " << input[2 * i + 1];
    }
}

kernels::LayerStackView view(const std::vector<LobeRecord>& lobes) {
    kernels::LayerStackView stack{};
    stack.record.has_top_lobe = 1;
    stack.record.other_side = NO_INDEX;
    stack.record.lobe_count = static_cast<std::uint32_t>(lobes.size());
    stack.layers = layers.data();
    stack.lobes = lobes.data();
    return stack;
}

TEST(KernelLayerStack, SamplesFollowTheirPdf) {
    // Chi-square of directions in 8 x 16 cells of (z, phi) against the integrated pdf.
    const std::vector<LobeRecord> lobes(
        LOBES, {0.4f, MICROFACET_BECKMANN, 1u, NO_INDEX, NO_INDEX, NO_INDEX});
    const kernels::LayerStackView stack = view(lobes);
    kernels::LayerChoice choice{};
    for (int i = 0; i < CHOICES; ++i)
        choice.cumulative[i] = std::min(static_cast<double>(i) / CHOICE_DIFFUSE, 1.0);
    const Vec3 wo = vec3(0.6, 0.0, 0.8);
    constexpr int rows = 8, columns = 16, count = 200000;
    std::vector<double> seen(rows * columns, 0.0);
    Source source(17);
    int below = 0;
    for (int i = 0; i < count; ++i) {
        int is_delta = 0;
        const Vec3 w =
            kernels::layer_stack_sample(stack, &choice, wo, source.uniform(0, 1),
                                        source.uniform(0, 1), source.uniform(0, 1), &is_delta);
        EXPECT_EQ(is_delta, 0);
        if (w.z <= 0.0) {
            ++below;
            continue;
        }
        const double phi = std::atan2(w.y, w.x) / 6.283185307179586 + 0.5;
        const int row = std::min(rows - 1, static_cast<int>(w.z * rows));
        const int column = std::min(columns - 1, static_cast<int>(phi * columns));
        const int cell = row * columns + column;
        seen[static_cast<std::size_t>(cell)] += 1.0;
    }
    double chi = 0.0, total = 0.0;
    constexpr int fine = 24;
    for (int cell = 0; cell < rows * columns; ++cell) {
        double integral = 0.0;
        const int row = cell / columns;
        for (int a = 0; a < fine; ++a)
            for (int b = 0; b < fine; ++b) {
                const double z = (row + (a + 0.5) / fine) / rows;
                const double phi =
                    ((cell % columns + (b + 0.5) / fine) / columns - 0.5) * 6.283185307179586;
                const double s = std::sqrt(1 - z * z);
                integral += kernels::layer_stack_pdf(stack, &choice, wo,
                                                     vec3(s * std::cos(phi), s * std::sin(phi), z));
            }
        integral *= 6.283185307179586 / (rows * columns * fine * fine);
        total += integral;
        const double expected = integral * count;
        const double d = seen[static_cast<std::size_t>(cell)] - expected;
        chi += d * d / std::max(expected, 1.0);
    }
    EXPECT_NEAR(total, 1.0 - static_cast<double>(below) / count, 5e-3);
    // 127 degrees of freedom; mean + 6 sd is beyond 1e-6.
    EXPECT_LT(chi, 127 + 6 * std::sqrt(254.0));
}

} // namespace
} // namespace reradiant
