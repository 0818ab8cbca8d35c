#pragma once

#include "host/geometry/geometry.h"

#include <random>
#include <vector>

namespace reradiant::testing {

Shape shape_of(decltype(Shape::geometry) geometry, int material = 0);

/// A sphere of triangles: an icosahedron, each face split in four `levels` times.
MeshShape triangle_sphere(const Vector3& centre, double radius, int levels);

/// Spheres, disks, rectangles and triangles of random size and place in a box of side 20, with
/// a rectangle and a sphere light among them.
Scene random_scene(unsigned seed);

RayRecord ray_record(const Vector3& origin, const Vector3& direction);
Vector3 random_direction(std::mt19937_64& random);
/// Rays from a box of side 24 in all directions.
std::vector<RayRecord> random_rays(std::size_t count, unsigned seed);

std::vector<HitRecord> trace(const Geometry& geometry, const std::vector<RayRecord>& rays,
                             bool coherent = false, int threads = 0);

double dot(const Vector3& a, const Vector3& b);
Vector3 sum(const Vector3& a, const Vector3& b, double b_scale);
Vector3 position_of(const HitRecord& hit);
Vector3 normal_of(const HitRecord& hit);

} // namespace reradiant::testing
