#pragma once

#include "host/geometry/embree_version.h"
#include "host/geometry/primitives.h"
#include "host/geometry/surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Embree calls these functions for shapes that are no meshes; they compute in double precision.

namespace reradiant {

/// Returns the bounds for Embree, which are in single precision: each is rounded outwards, and
/// widened a little more because a flat box is tested with rounding too, also after a surface was
/// found that lies in it.
inline RTCBounds outer_bounds(const Box& box) {
    const double extent =
        std::max({box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z});
    const auto widen = [extent](double value, double sign) {
        return static_cast<float>(value +
                                  sign * (std::fabs(value) * 2.5e-7 + extent * 1e-5 + 1e-35));
    };
    RTCBounds bounds{};
    bounds.lower_x = widen(box.lower.x, -1.0);
    bounds.lower_y = widen(box.lower.y, -1.0);
    bounds.lower_z = widen(box.lower.z, -1.0);
    bounds.upper_x = widen(box.upper.x, 1.0);
    bounds.upper_y = widen(box.upper.y, 1.0);
    bounds.upper_z = widen(box.upper.z, 1.0);
    return bounds;
}

inline Ray ray_of(RTCRayN* ray, unsigned int count, unsigned int i) {
    return {kernels::vec3(RTCRayN_org_x(ray, count, i), RTCRayN_org_y(ray, count, i),
                          RTCRayN_org_z(ray, count, i)),
            kernels::vec3(RTCRayN_dir_x(ray, count, i), RTCRayN_dir_y(ray, count, i),
                          RTCRayN_dir_z(ray, count, i)),
            RTCRayN_tnear(ray, count, i), RTCRayN_tfar(ray, count, i)};
}

template <typename Primitive>
const Primitive& primitive_of(const void* user, unsigned int index) {
    return static_cast<const OwnedPrimitives<Primitive>*>(user)->primitives[index];
}

template <typename Primitive>
void bounds_callback(const RTCBoundsFunctionArguments* arguments) {
    *arguments->bounds_o = outer_bounds(
        primitive_of<Primitive>(arguments->geometryUserPtr, arguments->primID).bounds());
}

/// True where a hit at `t` takes the place of the ray's nearest so far: it is nearer, or as near
/// (in single precision, which Embree compares) and of an earlier geometry of Embree's, or an
/// earlier primitive of the same one. Where surfaces coincide the result then does not hang on the
/// order in which Embree finds them, which depends on the other rays of a packet.
inline bool takes_place(float t, RTCRayN* rays, RTCHitN* hits, unsigned int count, unsigned int i,
                        unsigned int shape, unsigned int primitive) {
    const float nearest = RTCRayN_tfar(rays, count, i);
    const unsigned int instance = RTCHitN_instID(hits, count, i, 0);
    const unsigned int found =
        instance != RTC_INVALID_GEOMETRY_ID ? instance : RTCHitN_geomID(hits, count, i);
    if (t != nearest || found == RTC_INVALID_GEOMETRY_ID)
        return t < nearest;
    return shape < found || (shape == found && primitive < RTCHitN_primID(hits, count, i));
}

template <typename Primitive>
void intersect_callback(const RTCIntersectFunctionNArguments* arguments) {
    const auto& primitive = primitive_of<Primitive>(arguments->geometryUserPtr, arguments->primID);
    const unsigned int count = arguments->N;
    RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, count);
    RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, count);
    double* distances = reinterpret_cast<PacketContext*>(arguments->context)->distances;
    for (unsigned int i = 0; i < count; ++i) {
        if (arguments->valid[i] == 0)
            continue;
        Ray ray = ray_of(rays, count, i);
        ray.t_far *= 1.0 + 1e-7; // what is as near in single precision, too
        const double t = primitive.intersect(ray);
        if (t < 0.0 || !takes_place(static_cast<float>(t), rays, hits, count, i, arguments->geomID,
                                    arguments->primID))
            continue;
        RTCRayN_tfar(rays, count, i) = static_cast<float>(t);
        distances[RTCRayN_id(rays, count, i)] = t;
        RTCHitN_geomID(hits, count, i) = arguments->geomID;
        RTCHitN_primID(hits, count, i) = arguments->primID;
        RTCHitN_instID(hits, count, i, 0) = arguments->context->instID[0];
    }
}

template <typename Primitive>
void occluded_callback(const RTCOccludedFunctionNArguments* arguments) {
    const auto& primitive = primitive_of<Primitive>(arguments->geometryUserPtr, arguments->primID);
    for (unsigned int i = 0; i < arguments->N; ++i)
        if (arguments->valid[i] != 0 &&
            primitive.intersect(ray_of(arguments->ray, arguments->N, i)) >= 0.0)
            RTCRayN_tfar(arguments->ray, arguments->N, i) = -std::numeric_limits<float>::infinity();
}

} // namespace reradiant
