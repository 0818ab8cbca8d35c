#include "tests/geometry/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <numeric>
#include <string>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

bool same_bits(const std::vector<HitRecord>& a, const std::vector<HitRecord>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

Scene scene_with_mesh() {
    Scene scene = random_scene(11);
    scene.shapes.push_back(shape_of(triangle_sphere({0, 0, 0}, 8.0, 4)));
    return scene;
}

/// Returns the million rays traced in a second of processor time, so that what else the machine
/// does counts for nothing.
double million_rays_per_second(const Geometry& geometry, const std::vector<RayRecord>& rays,
                               bool coherent) {
    std::vector<HitRecord> hits(rays.size());
    geometry.intersect(rays, hits, coherent, 1);
    const std::clock_t start = std::clock();
    geometry.intersect(rays, hits, coherent, 1);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    return static_cast<double>(rays.size()) / seconds * 1e-6;
}

/// Returns the kilobytes of the heap and of other private memory, resident or not.
long taken_kilobytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmData:"))
            return std::stol(line.substr(7));
    return 0;
}

} // namespace

TEST(Batches, HitsDoNotDependOnThreadsBatchSizeOrCoherence) {
    const Geometry geometry(scene_with_mesh());
    const auto rays = random_rays(100003, 12);
    const auto expected = trace(geometry, rays, false, 1);
    for (const int threads : {0, 2, 3})
        EXPECT_TRUE(same_bits(trace(geometry, rays, false, threads), expected)) << threads;
    EXPECT_TRUE(same_bits(trace(geometry, rays, true, 0), expected));
    for (const std::size_t size : {1u, 7u, 1000u, 50001u}) {
        std::vector<HitRecord> hits(rays.size());
        const std::size_t end = size == 1 ? 5000 : rays.size();
        for (std::size_t at = 0; at < end; at += size) {
            const std::size_t count = std::min(size, end - at);
            geometry.intersect(std::span(rays).subspan(at, count),
                               std::span(hits).subspan(at, count), false, 0);
        }
        EXPECT_EQ(std::memcmp(hits.data(), expected.data(), end * sizeof(HitRecord)), 0) << size;
    }
}

/// Embree meets the rays of a packet together, so that which of two surfaces comes first depends on
/// the packet.
TEST(Batches, TheEarlierOfSurfacesThatCoincideIsHit) {
    Scene scene;
    scene.shapes.push_back(shape_of(RectangleShape{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}));
    scene.shapes.push_back(shape_of(RectangleShape{{0.3, 0.2, 0}, {3, 0, 0}, {0, 5, 0}}));
    scene.shapes.push_back(shape_of(DiskShape{{-0.5, 0, 0}, {0, 0, 1}, 2.0}));
    const Geometry geometry(scene);
    const auto rays = random_rays(100003, 13);
    const auto together = trace(geometry, rays, false, 0);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto alone = trace(geometry, {rays[i]}, false, 1);
        ASSERT_TRUE(same_bits(alone, {together[i]})) << "ray " << i;
        const float x = together[i].position_x, y = together[i].position_y;
        const bool on_first = std::fabs(x) < 1.99f && std::fabs(y) < 1.99f;
        ASSERT_TRUE(!on_first || together[i].shape == 0u || together[i].shape == NO_INDEX)
            << "ray " << i << " at " << x << ' ' << y << " hits " << together[i].shape;
    }
}

TEST(Batches, TwoGeometriesOfOneSceneAgree) {
    const Geometry first(scene_with_mesh()), second(scene_with_mesh());
    const auto rays = random_rays(50000, 13);
    EXPECT_TRUE(same_bits(trace(first, rays), trace(second, rays)));
}

TEST(Batches, OcclusionAgreesWithTheNearestHit) {
    const Geometry geometry(random_scene(14));
    auto rays = random_rays(100000, 15);
    const auto hits = trace(geometry, rays);
    auto shorter = rays, longer = rays;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (hits[i].distance > 0.0f) {
            shorter[i].t_far = 0.999f * hits[i].distance;
            longer[i].t_far = 1.001f * hits[i].distance;
        }
    geometry.occlude(rays, 0);
    geometry.occlude(shorter, 2);
    geometry.occlude(longer, 1);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool hit = hits[i].shape != NO_INDEX || hits[i].light != NO_INDEX;
        EXPECT_EQ(rays[i].t_far < 0.0f, hit) << i;
        EXPECT_GT(shorter[i].t_far, 0.0f) << i;
        EXPECT_EQ(longer[i].t_far < 0.0f, hit) << i;
    }
}

TEST(Batches, InactiveRaysHitNothing) {
    Scene scene;
    scene.shapes = {shape_of(SphereShape{{0, 0, 0}, 1.0})};
    const Geometry geometry(scene);
    RayRecord ray = ray_record({0, 0, 5}, {0, 0, -1});
    ray.t_far = -1.0f;
    EXPECT_EQ(trace(geometry, {ray})[0].shape, NO_INDEX);
    geometry.occlude({&ray, 1}, 0);
    EXPECT_EQ(ray.t_far, -1.0f);
}

TEST(Batches, AnEmptySceneAndAnEmptyBatchAreOrdinary) {
    const Geometry geometry{Scene{}};
    EXPECT_EQ(trace(geometry, random_rays(100, 1))[99].shape, NO_INDEX);
    EXPECT_TRUE(trace(geometry, {}).empty());
    EXPECT_EQ(geometry.triangle_count(), 0u);
}

TEST(Batches, SpeedIsReported) {
    const Geometry geometry(scene_with_mesh());
    std::vector<RayRecord> camera;
    for (int y = 0; y < 1000; ++y)
        for (int x = 0; x < 1000; ++x) {
            const Vector3 way{(x - 500) * 1e-3, (y - 500) * 1e-3, -1.0};
            camera.push_back(ray_record({0, 0, 25}, sum({}, way, 1.0 / std::sqrt(dot(way, way)))));
        }
    const double coherent = million_rays_per_second(geometry, camera, true);
    const double incoherent = million_rays_per_second(geometry, random_rays(1000000, 16), false);
    std::printf("%s, %zu triangles and 50 others: %.2f coherent, %.2f incoherent million rays "
                "a core second, "
                "%zu bytes\n",
                geometry.library_version(), geometry.triangle_count(), coherent, incoherent,
                geometry.memory_bytes());
    EXPECT_GT(coherent, 0.0);
    EXPECT_GT(geometry.memory_bytes(), 1000u);
}

// A day of rendering traces millions of batches: 2,000 took 16 MB more when each had an arena of
// its own.
TEST(Batches, TracingTakesNoMemoryThatStays) {
    const Geometry geometry(scene_with_mesh());
    const std::vector<RayRecord> rays = random_rays(64, 3);
    std::vector<HitRecord> hits(rays.size());
    const auto trace = [&](int batches) {
        for (int batch = 0; batch < batches; ++batch)
            geometry.intersect(rays, hits, false, 0);
    };
    trace(100);
    const long before = taken_kilobytes();
    trace(2000);
    EXPECT_LT(taken_kilobytes() - before, 2000);
}
