#include "host/geometry/geometry.h"

#include "host/geometry/embree_scene.h"
#include "host/geometry/embree_version.h"
#include "host/geometry/opacity.h"
#include "host/geometry/ray_packet.h"
#include "host/geometry/surfaces.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>

#include <fmt/core.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace reradiant {

namespace {

Ray ray_of(const RayRecord& r) {
    return {kernels::vec3(r.origin_x, r.origin_y, r.origin_z),
            kernels::vec3(r.direction_x, r.direction_y, r.direction_z), r.t_near,
            std::numeric_limits<double>::infinity()};
}

bool is_traceable(const RayRecord& r) {
    const float sum = r.origin_x + r.origin_y + r.origin_z + r.direction_x + r.direction_y +
                      r.direction_z + r.t_near;
    const bool has_direction =
        r.direction_x != 0.0f || r.direction_y != 0.0f || r.direction_z != 0.0f;
    // Debian's Embree aborts on a ray that is not finite.
    return r.t_far >= 0.0f && std::isfinite(sum) && has_direction;
}

HitRecord no_hit() {
    HitRecord record{};
    record.shape = record.material = record.light = NO_INDEX;
    return record;
}

HitRecord record_of(const SurfaceHit& hit, const Owner& owner) {
    const auto f = [](double x) { return static_cast<float>(x); };
    HitRecord r{};
    r.position_x = f(hit.position.x);
    r.position_y = f(hit.position.y);
    r.position_z = f(hit.position.z);
    r.position_error = f(hit.position_error);
    r.normal_x = f(hit.normal.x);
    r.normal_y = f(hit.normal.y);
    r.normal_z = f(hit.normal.z);
    r.distance = f(hit.distance);
    r.shading_x = f(hit.shading.x);
    r.shading_y = f(hit.shading.y);
    r.shading_z = f(hit.shading.z);
    r.shape = owner.shape;
    r.u = f(hit.u);
    r.v = f(hit.v);
    r.material = owner.material;
    r.light = owner.light;
    return r;
}

float cosine_of(const RayRecord& ray, const HitRecord& found) {
    return found.normal_x * ray.direction_x + found.normal_y * ray.direction_y +
           found.normal_z * ray.direction_z;
}

/// Moves the origin of a ray behind what it has met, beyond the error of that place, as kernels do
/// (kernels/stages/rays.h).
void go_on_behind(const HitRecord& found, float cosine, RayRecord& ray) {
    const float reach =
        2.0f * found.position_error *
        (std::fabs(found.normal_x) + std::fabs(found.normal_y) + std::fabs(found.normal_z)) *
        (cosine < 0.0f ? -1.0f : 1.0f);
    ray.origin_x = found.position_x + reach * found.normal_x;
    ray.origin_y = found.position_y + reach * found.normal_y;
    ray.origin_z = found.position_z + reach * found.normal_z;
    ray.t_near = 0.0f;
    ray.t_far -= found.distance;
}

/// The arena of so many threads (0: all). Kept: oneTBB 2021 gives none of the 8 KB back that each
/// new one takes, 400 MB an hour of rendering.
tbb::task_arena& arena_of(int threads) {
    static std::mutex mutex;
    static std::map<int, tbb::task_arena> arenas;
    const std::scoped_lock lock(mutex);
    const int slots = threads > 0 ? threads : int{tbb::task_arena::automatic};
    return arenas.try_emplace(threads, slots).first->second;
}

/// Runs work(begin, end) for pieces of [0, count) on `threads` threads (0: all). The pieces are the
/// same whatever the threads are.
template <typename Work>
void for_each_chunk(std::size_t count, int threads, const Work& work) {
    constexpr std::size_t RAYS_A_TASK = 1024;
    arena_of(threads).execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, RAYS_A_TASK),
            [&](const tbb::blocked_range<std::size_t>& range) { work(range.begin(), range.end()); },
            tbb::simple_partitioner());
    });
}

std::vector<std::uint32_t> places_of(std::size_t count) {
    std::vector<std::uint32_t> places(count);
    std::iota(places.begin(), places.end(), 0u);
    return places;
}

} // namespace

struct Geometry::Implementation {
    Implementation(const Scene& scene, bool wants_parameters);

    /// Finds the nearest hits of the rays that `live` lists from `begin` to `end`.
    void hit(const RaysToHit& rays, std::size_t begin, std::size_t end) const;
    void hit(const RaysToHit& rays, Packet<RTCRayHit16>& packet) const;
    /// Marks those of the listed rays that something blocks; returns how many were active.
    std::uint64_t block(const RaysToBlock& rays, std::size_t begin, std::size_t end) const;
    void block(const RaysToBlock& rays, Packet<RTCRay16>& packet) const;
    bool goes_through(const RaysToBlock& rays, std::uint32_t place, bool is_met) const;
    HitRecord behind_openings(RayRecord ray, HitRecord found) const;
    HitRecord nearest(const RayRecord& ray) const;
    HitRecord describe(const RayRecord& record, const RTCRayHit16& found, std::size_t k,
                       double distance) const;
    template <typename Primitive>
    HitRecord describe(const OwnedPrimitives<Primitive>& owned, unsigned int index, Ray ray,
                       double t) const;

    Surfaces surfaces;
    Opacity opacity;
    bool parameters;
    EmbreeScene embree;
};

Geometry::Implementation::Implementation(const Scene& scene_in, bool wants_parameters)
    : surfaces(surfaces_of(scene_in)), opacity(scene_in),
      parameters(wants_parameters || !opacity.is_empty()), embree(surfaces) {}

template <typename Primitive>
HitRecord Geometry::Implementation::describe(const OwnedPrimitives<Primitive>& owned,
                                             unsigned int index, Ray ray, double t) const {
    const Primitive& primitive = owned.primitives[index];
    SurfaceHit hit = primitive.describe(ray, t);
    if (parameters)
        primitive.set_parameters(hit);
    return record_of(hit, owned.owners[index]);
}

HitRecord Geometry::Implementation::describe(const RayRecord& record, const RTCRayHit16& found,
                                             std::size_t k, double distance) const {
    const unsigned int index = found.hit.primID[k];
    const Ray ray = ray_of(record);
    const void* source = embree.source(found.hit.geomID[k], found.hit.instID[0][k]);
    if (source == &surfaces.spheres)
        return describe(surfaces.spheres, index, ray, distance);
    if (source == &surfaces.rectangles)
        return describe(surfaces.rectangles, index, ray, distance);
    if (source == &surfaces.disks)
        return describe(surfaces.disks, index, ray, distance);
    if (source == &surfaces.cylinders)
        return describe(surfaces.cylinders, index, ray, distance);
    const auto& owned = *static_cast<const OwnedMesh*>(source);
    return record_of(describe_on_mesh(owned, index, ray, {found.hit.u[k], found.hit.v[k]}),
                     owned.owner);
}

void Geometry::Implementation::hit(const RaysToHit& rays, std::size_t begin,
                                   std::size_t end) const {
    Packet<RTCRayHit16> packet;
    for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t place = rays.live[i];
        if (is_traceable(rays.rays[place]))
            packet.add(rays.rays[place], place);
        else
            rays.hits[place] = no_hit();
        if (packet.is_full() || (i + 1 == end && !packet.is_empty()))
            hit(rays, packet);
    }
}

void Geometry::Implementation::hit(const RaysToHit& rays, Packet<RTCRayHit16>& packet) const {
    RTCRayHit16& found = packet.rays();
    std::fill_n(found.hit.geomID, packet_rays, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(found.hit.instID[0], packet_rays, RTC_INVALID_GEOMETRY_ID);
    std::array<double, packet_rays> distances{}; // of shapes that are no meshes
    embree_intersect(embree.scene(), packet.valid(), found, rays.coherent, distances.data());
    for (int i = 0; i < packet.count(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const std::uint32_t place = packet.place(i);
        rays.hits[place] = found.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID
                               ? no_hit()
                               : describe(rays.rays[place], found, k, distances[k]);
        if (!opacity.is_empty())
            rays.hits[place] = behind_openings(rays.rays[place], rays.hits[place]);
    }
    packet.clear();
}

/// Returns the nearest hit of one ray, whatever its opacity.
HitRecord Geometry::Implementation::nearest(const RayRecord& ray) const {
    Packet<RTCRayHit16> packet;
    packet.add(ray, 0);
    RTCRayHit16& found = packet.rays();
    found.hit.geomID[0] = found.hit.instID[0][0] = RTC_INVALID_GEOMETRY_ID;
    std::array<double, packet_rays> distances{};
    embree_intersect(embree.scene(), packet.valid(), found, false, distances.data());
    return found.hit.geomID[0] == RTC_INVALID_GEOMETRY_ID ? no_hit()
                                                          : describe(ray, found, 0, distances[0]);
}

/// Returns the first hit of a ray, from its nearest one on, that its surface does not let through.
HitRecord Geometry::Implementation::behind_openings(RayRecord ray, HitRecord found) const {
    float passed = 0.0f;
    while (!opacity.stops(ray, found)) {
        passed += found.distance;
        go_on_behind(found, cosine_of(ray, found), ray);
        found = ray.t_far >= 0.0f ? nearest(ray) : no_hit();
    }
    found.distance += passed;
    return found;
}

std::uint64_t Geometry::Implementation::block(const RaysToBlock& rays, std::size_t begin,
                                              std::size_t end) const {
    std::uint64_t active = 0;
    Packet<RTCRay16> packet;
    for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t place = rays.live[i];
        RayRecord& ray = rays.rays[place];
        active += ray.t_far >= 0.0f ? 1 : 0;
        if (is_traceable(ray))
            packet.add(ray, place);
        else
            ray.t_far = -1.0f;
        if (packet.is_full() || (i + 1 == end && !packet.is_empty()))
            block(rays, packet);
    }
    return active;
}

void Geometry::Implementation::block(const RaysToBlock& rays, Packet<RTCRay16>& packet) const {
    embree_occluded(embree.scene(), packet.valid(), packet.rays());
    for (int i = 0; i < packet.count(); ++i) {
        const std::uint32_t place = packet.place(i);
        const bool is_met = packet.rays().tfar[static_cast<std::size_t>(i)] < 0.0f;
        const bool may_pass = !rays.sheets.materials.empty() || !opacity.is_empty();
        if (may_pass ? !goes_through(rays, place, is_met) : is_met)
            rays.rays[place].t_far = -1.0f;
    }
    packet.clear();
}

/// Follows a ray that meets something as far as that lets it through or are smooth sheets, and
/// notes these. Returns false where it is blocked.
bool Geometry::Implementation::goes_through(const RaysToBlock& rays, std::uint32_t place,
                                            bool is_met) const {
    const bool has_sheets = !rays.sheets.materials.empty();
    const auto crossings =
        has_sheets
            ? rays.sheets.crossings.subspan(std::size_t{place} * MOST_CROSSINGS, MOST_CROSSINGS)
            : std::span<SheetCrossing>();
    std::ranges::fill(crossings, SheetCrossing{NO_INDEX, 0.0f});
    RayRecord ray = rays.rays[place];
    const std::uint32_t only = 0;
    for (unsigned passed = 0; is_met; ++passed) {
        HitRecord found{};
        hit({{&ray, 1}, {&found, 1}, {&only, 1}}, 0, 1);
        if (found.shape == NO_INDEX && found.light == NO_INDEX)
            return true;
        if (found.distance >= ray.t_far)
            return true;
        const std::uint32_t sheet = has_sheets && found.light == NO_INDEX
                                        ? rays.sheets.materials[found.material]
                                        : NO_INDEX;
        if (sheet == NO_INDEX || passed >= rays.sheets.most)
            return false;
        const float cosine = cosine_of(ray, found);
        crossings[passed] = {sheet, std::fabs(cosine)};
        go_on_behind(found, cosine, ray);
    }
    return true;
}

Geometry::Geometry(const Scene& scene, bool wants_parameters)
    : implementation_(std::make_unique<Implementation>(scene, wants_parameters)) {}
Geometry::~Geometry() = default;

void Geometry::intersect(std::span<const RayRecord> rays, std::span<HitRecord> hits, bool coherent,
                         int threads) const {
    const std::vector<std::uint32_t> all = places_of(rays.size());
    trace({rays, hits, all, coherent}, {}, threads);
}

void Geometry::occlude(std::span<RayRecord> rays, int threads) const {
    const std::vector<std::uint32_t> all = places_of(rays.size());
    trace({}, {rays, all}, threads);
}

TraceStatistics Geometry::trace(const RaysToHit& rays, const RaysToBlock& shadow_rays,
                                int threads) const {
    using Clock = std::chrono::steady_clock;
    const std::size_t shadows = shadow_rays.live.size();
    std::atomic<std::uint64_t> blockable{0};
    std::atomic<std::int64_t> hit_ns{0}, block_ns{0};
    for_each_chunk(shadows + rays.live.size(), threads, [&](std::size_t begin, std::size_t end) {
        const std::size_t split = std::clamp(shadows, begin, end);
        const Clock::time_point start = Clock::now();
        blockable += implementation_->block(shadow_rays, begin, split);
        const Clock::time_point between = Clock::now();
        if (split < end)
            implementation_->hit(rays, split - shadows, end - shadows);
        block_ns += std::chrono::nanoseconds(between - start).count();
        hit_ns += std::chrono::nanoseconds(Clock::now() - between).count();
    });
    return {1e-9 * static_cast<double>(hit_ns), 1e-9 * static_cast<double>(block_ns), blockable};
}

std::size_t Geometry::triangle_count() const {
    return implementation_->embree.triangles();
}

std::size_t Geometry::memory_bytes() const {
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(implementation_->embree.bytes(), 0));
}

const char* Geometry::library_version() const {
    return implementation_->embree.version().c_str();
}

} // namespace reradiant
