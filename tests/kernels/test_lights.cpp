#include "kernels/scene/cone_lights.h"
#include "kernels/scene/lights.h"
#include "kernels/scene/shaped_lights.h"
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

/// Two triangles of areas 1 and 3: the mean of a quarter of all points lies in the first, and
/// within each the mean point is its centroid.
TEST(KernelLights, MeshesAreSampledByArea) {
    const std::vector<float> tables{0.25f, 1.0f, 0, 0, 0,  2, 0, 0,  0, 1,
                                    0,     10,   0, 0, 12, 0, 0, 10, 3, 0};
    LightRecord mesh{};
    mesh.type = LIGHT_MESH;
    mesh.triangle_count = 2;
    constexpr int steps = 400;
    double first = 0.0, x_first = 0.0, y_first = 0.0, y_second = 0.0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const kernels::LightPoint point = kernels::shaped_lights_mesh(
                mesh, tables.data(), (i + 0.5) / steps, (j + 0.5) / steps);
            EXPECT_EQ(point.normal.z, 1.0);
            const bool in_first = point.position.x < 5.0;
            first += in_first;
            x_first += in_first ? point.position.x : 0.0;
            (in_first ? y_first : y_second) += point.position.y;
        }
    EXPECT_EQ(first, 0.25 * steps * steps);
    // Midpoints of a square root's integral: an error of some 1 / steps at most.
    EXPECT_NEAR(x_first / first, 2.0 / 3.0, 5e-3);
    EXPECT_NEAR(y_first / first, 1.0 / 3.0, 5e-3);
    EXPECT_NEAR(y_second / (3.0 * first), 1.0, 5e-3);
}

TEST(KernelLights, DistantLightsHoldTheDirectionsThatTheySample) {
    LightRecord sun{};
    sun.ny = -0.6f;
    sun.nz = 0.8f;
    for (const float cone : {1.08e-5f, 0.3f}) {
        sun.cone = cone;
        for (const double u : {0.0, 0.5, 0.999})
            for (const double v : {0.0, 0.3, 0.7}) {
                const kernels::LightSample s = kernels::cone_lights_distant(sun, u, v);
                EXPECT_TRUE(kernels::cone_lights_holds(sun, s.direction)) << u;
                EXPECT_NEAR(s.weight * s.pdf, kernels::cone_lights_radiance(sun),
                            1e-6 * kernels::cone_lights_radiance(sun));
            }
        const double sine = std::sqrt(1.01 * cone * (2.0 - 1.01 * cone));
        const double cosine = 1.0 - 1.01 * cone;
        EXPECT_FALSE(
            kernels::cone_lights_holds(sun, kernels::vec3(sine, 0.6 * cosine, -0.8 * cosine)));
        EXPECT_FALSE(kernels::cone_lights_holds(sun, kernels::vec3(0.0, -0.6, 0.8)));
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
