#pragma once

#include "host/scene/meshes/placement.h"
#include "kernels/core/portable.h"
#include "reradiant/scene.h"

#include <array>
#include <cstdint>

namespace reradiant {

using kernels::Vec3;

inline Vec3 to_vec3(const Vector3& v) {
    return kernels::vec3(v[0], v[1], v[2]);
}

/// A ray in double precision; records hold single precision, which converts exactly.
struct Ray {
    Vec3 origin, direction;
    double t_near, t_far;

    Vec3 at(double t) const { return kernels::vec3_add(origin, kernels::vec3_scale(direction, t)); }
};

/// A point on a surface.
struct SurfaceHit {
    Vec3 position, normal, shading;
    double u, v;
    double distance;
    double position_error; ///< error of each coordinate, rounding to single precision included
};

struct Box {
    Vec3 lower, upper;
};

/// Shapes that are not made of triangles are intersected in double precision: then the surface that
/// rays meet is the one that positions are computed on, and a hit's error is that of rounding its
/// coordinates to single precision. `intersect` returns the nearest t in (t_near, t_far), or -1.
/// `describe` leaves u and v at zero; `set_parameters` sets them for callers that need them.

struct SpherePrimitive {
    Vec3 centre;
    double radius;

    double intersect(const Ray& ray) const;
    /// u = azimuth about z over 2 pi, v = angle from z over pi; the normal points outward.
    SurfaceHit describe(const Ray& ray, double t) const;
    void set_parameters(SurfaceHit& hit) const;
    Box bounds() const;
};

/// Both sides; the normal is that of cross(edge_u, edge_v).
struct RectanglePrimitive {
    RectanglePrimitive(const Vector3& centre, const Vector3& edge_u, const Vector3& edge_v);

    double intersect(const Ray& ray) const;
    SurfaceHit describe(const Ray& ray, double t) const;
    void set_parameters(SurfaceHit& hit) const;
    Box bounds() const;

    Vec3 centre, edge_u, edge_v;
    Vec3 normal;         ///< unit
    Vec3 dual_u, dual_v; ///< dual_u . edge_u = 1, dual_u . edge_v = 0
};

/// Both sides. u = distance from the centre over the radius, v = azimuth over 2 pi.
struct DiskPrimitive {
    DiskPrimitive(const Vector3& centre, const Vector3& normal, double radius);

    double intersect(const Ray& ray) const;
    SurfaceHit describe(const Ray& ray, double t) const;
    void set_parameters(SurfaceHit& hit) const;
    Box bounds() const;

    Vec3 centre, normal, tangent;
    double radius;
};

/// An open tube, from both sides; the normal points away from its axis. u = azimuth over 2 pi, v =
/// distance along the axis over the length.
struct CylinderPrimitive {
    CylinderPrimitive(const Vector3& from, const Vector3& to, double radius);

    double intersect(const Ray& ray) const;
    SurfaceHit describe(const Ray& ray, double t) const;
    void set_parameters(SurfaceHit& hit) const;
    Box bounds() const;

    Vec3 from, axis, tangent; ///< axis and tangent: unit
    double length, radius;
};

/// One triangle of a mesh that Embree found.
struct TrianglePrimitive {
    std::array<Vec3, 3> corners;

    /// Returns the barycentric coordinates of the second and third corner where the ray meets the
    /// triangle, pulled into it, or `fallback` (Embree's) where the ray lies in its plane.
    std::array<double, 2> barycentric(const Ray& ray, std::array<double, 2> fallback) const;
    SurfaceHit describe(const Ray& ray, std::array<double, 2> barycentric) const;
};

TrianglePrimitive triangle_of(const MeshShape& mesh, std::uint32_t triangle);
/// Replaces shading normal and parameters of a hit by those that the mesh gives its vertices;
/// `placement` moves an instance's normals, null: there is none.
void interpolate_vertex_data(const MeshShape& mesh, std::uint32_t triangle,
                             std::array<double, 2> barycentric, const Placement* placement,
                             SurfaceHit& hit);

} // namespace reradiant
