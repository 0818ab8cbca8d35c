#include "kernels/scene/lights.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

LightRecord record(const float* p) {
    LightRecord light{};
    light.type = static_cast<std::uint32_t>(p[0]);
    light.px = p[1];
    light.py = p[2];
    light.pz = p[3];
    light.radius_or_area = p[4];
    light.ux = 2.0f;
    light.vz = 3.0f;
    light.ny = -1.0f;
    return light;
}

TEST(KernelLights, AreChosenByTheirCumulativeProbability) {
    std::vector<LightRecord> lights(3, LightRecord{});
    lights[0].cumulative = 0.25f;
    lights[1].cumulative = 0.25f;   // is never chosen
    lights[2].cumulative = 0.9999f; // rounding left a gap
    EXPECT_EQ(kernels::lights_choose(lights.data(), 3, 0.0), 0u);
    EXPECT_EQ(kernels::lights_choose(lights.data(), 3, 0.2499), 0u);
    EXPECT_EQ(kernels::lights_choose(lights.data(), 3, 0.25), 2u);
    EXPECT_EQ(kernels::lights_choose(lights.data(), 3, 0.99999), 2u);
    EXPECT_EQ(kernels::lights_choose(lights.data(), 1, 0.5), 0u);
}

TEST(KernelLights, SamplesMatchDouble) {
    Source source(11);
    std::vector<float> input;
    constexpr std::size_t count = 40000;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t type = static_cast<std::uint32_t>(i % 4);
        input.push_back(static_cast<float>(type));
        // Far spheres too: 1 - cos of the cone must not cancel.
        const double far = std::pow(10.0, source.uniform(0.0, 3.0));
        for (int k = 0; k < 3; ++k)
            input.push_back(static_cast<float>(far * (k == 1 ? 1.0 : source.uniform(-1, 1))));
        input.push_back(type == LIGHT_SPHERE ? 0.5f : 6.0f);
        input.push_back(static_cast<float>(source.uniform(0, 1)));
        input.push_back(static_cast<float>(source.uniform(0, 1)));
    }
    const std::vector<float> found = run_probe("probe_lights", input, count, 6);
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = input.data() + 7 * i;
        const kernels::LightSample s =
            kernels::lights_sample(record(p), kernels::vec3(0, 0, 0), p[5], p[6]);
        EXPECT_LT(relative_difference(found[6 * i], s.weight, 1e-20), 2e-5) << "type " << p[0];
        EXPECT_LT(relative_difference(found[6 * i + 1], s.pdf, 1e-20), 2e-5) << "type " << p[0];
        // A sphere's surface is found by a square root that cancels at its rim.
        EXPECT_LT(relative_difference(found[6 * i + 2], s.distance, 0.1), 2e-3) << "type " << p[0];
        EXPECT_NEAR(found[6 * i + 3], s.direction.x, 2e-6);
        EXPECT_NEAR(found[6 * i + 4], s.direction.y, 2e-6);
        EXPECT_NEAR(found[6 * i + 5], s.direction.z, 2e-6);
    }
}

TEST(KernelLights, MisWeightsAddToOne) {
    for (const double a : {1e-30, 1e-3, 1.0, 1e10, 1e30})
        for (const double b : {1e-30, 1.0, 1e20})
            EXPECT_NEAR(kernels::lights_mis_weight(a, b) + kernels::lights_mis_weight(b, a), 1.0,
                        1e-12);
    EXPECT_EQ(kernels::lights_mis_weight(0.0, 1.0), 0.0);
}

} // namespace
} // namespace reradiant
