#include "kernels/scene/camera.h"
#include "tests/kernels/probe.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

using namespace test;

CameraRecord lens_camera() {
    CameraRecord camera{};
    camera.origin_z = 5.0f;
    camera.lens_radius = 0.2f;
    camera.right_x = 0.5f;
    camera.up_y = 0.3f;
    camera.forward_z = -1.0f;
    camera.focus_distance = 4.0f;
    camera.width = 50;
    camera.height = 30;
    return camera;
}

TEST(KernelCamera, MatchesDouble) {
    Source source(5);
    std::vector<float> input;
    constexpr std::size_t count = 10000;
    for (std::size_t i = 0; i < count; ++i) {
        input.push_back(static_cast<float>(source.uniform(0, 50)));
        input.push_back(static_cast<float>(source.uniform(0, 30)));
        input.push_back(static_cast<float>(source.uniform(0, 1)));
        input.push_back(static_cast<float>(source.uniform(0, 1)));
    }
    const std::vector<float> found = run_probe("probe_camera", input, count, 6, lens_camera());
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = input.data() + 4 * i;
        const kernels::CameraRay ray = kernels::camera_ray(lens_camera(), p[0], p[1], p[2], p[3]);
        EXPECT_NEAR(found[6 * i], ray.origin.x, 1e-6);
        EXPECT_NEAR(found[6 * i + 3], ray.direction.x, 1e-6);
        EXPECT_NEAR(found[6 * i + 4], ray.direction.y, 1e-6);
        EXPECT_NEAR(found[6 * i + 5], ray.direction.z, 1e-6);
    }
}

TEST(KernelCamera, RaysThroughTheLensMeetInThePlaneOfFocus) {
    for (const double u : {0.0, 0.3, 0.9}) {
        const kernels::CameraRay ray = kernels::camera_ray(lens_camera(), 40.0, 10.0, u, 0.37);
        const double t = -4.0 / ray.direction.z; // to z = 1, 4 before the camera
        EXPECT_NEAR(ray.origin.x + t * ray.direction.x, 4.0 * 0.5 * 0.6, 1e-6);
        EXPECT_NEAR(ray.origin.y + t * ray.direction.y, 4.0 * 0.3 / 3.0, 1e-6);
    }
}

} // namespace
} // namespace reradiant
