// Records that host and device both see, declared once. Only 32-bit scalars, no float3, so that
// both sides lay them out alike; sizes are asserted on both sides.
#ifndef RERADIANT_SHARED_H
#define RERADIANT_SHARED_H

#ifdef __OPENCL_VERSION__
typedef float shared_float;
typedef uint shared_uint;
typedef int shared_int;
#define ASSERT_SIZE(type, bytes) typedef char type##_size_check[(sizeof(type) == (bytes)) ? 1 : -1]
#else
#include <cstdint>
namespace reradiant {
using shared_float = float;
using shared_uint = std::uint32_t;
using shared_int = std::int32_t;
#define ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
#endif

#define NO_INDEX 0xffffffffu

/// A ray in world space. Direction has unit length. A ray with t_far < 0 is inactive: nothing
/// is traced for it. After an occlusion query t_far < 0 means "occluded or inactive".
typedef struct {
    shared_float origin_x, origin_y, origin_z;
    shared_float t_near;
    shared_float direction_x, direction_y, direction_z;
    shared_float t_far;
} RayRecord;
ASSERT_SIZE(RayRecord, 32);

/// Nearest intersection. shape = NO_INDEX: the ray left the scene.
typedef struct {
    shared_float position_x, position_y, position_z; ///< on the surface, world space
    shared_float position_error;                     ///< bound on each coordinate's error
    shared_float normal_x, normal_y, normal_z;       ///< geometric, unit, outward
    shared_float distance;                           ///< along the ray
    shared_float shading_x, shading_y, shading_z;    ///< unit; same side as the geometric one
    shared_uint shape;                               ///< index into Scene::shapes or NO_INDEX
    shared_float u, v;                               ///< surface parameters, 0..1
    shared_uint material;                            ///< index into Scene::materials or NO_INDEX
    shared_uint light;                               ///< index into Scene::lights or NO_INDEX
} HitRecord;
ASSERT_SIZE(HitRecord, 64);

#ifndef __OPENCL_VERSION__
} // namespace reradiant
#endif

#endif
