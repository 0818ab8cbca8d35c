#include "host/geometry/primitives.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

using namespace kernels;

namespace {

constexpr double PI = 3.14159265358979323846;
/// Half a unit in the last place of single precision, relative.
constexpr double FLOAT_ROUNDING = 0x1p-24;
constexpr double SMALLEST_FLOAT = std::numeric_limits<float>::denorm_min();

double largest_component(const Vec3& v) {
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

/// Rounding of the position to single precision, and half as much again because moving it along
/// the normal is rounded in the next binade at worst.
double rounding_error(const Vec3& position) {
    return 1.5 * FLOAT_ROUNDING * largest_component(position) + SMALLEST_FLOAT;
}

Vec3 any_perpendicular(const Vec3& n) {
    const Vec3 axis = std::fabs(n.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    return vec3_normalise(vec3_cross(n, axis));
}

/// Distance to a plane through `point`, -1 when parallel or out of range.
double intersect_plane(const Ray& ray, const Vec3& point, const Vec3& normal) {
    const double t =
        vec3_dot(normal, vec3_sub(point, ray.origin)) / vec3_dot(normal, ray.direction);
    return t > ray.t_near && t < ray.t_far ? t : -1.0;
}

double azimuth_share(double y, double x) {
    const double share = std::atan2(y, x) / (2.0 * PI);
    return share < 0.0 ? share + 1.0 : share;
}

Vec3 scaled_to_unit(const Vec3& v) {
    return vec3_normalise(vec3_scale(v, 1.0 / largest_component(v)));
}

SurfaceHit flat_hit(const Vec3& position, const Vec3& normal, double u, double v, double t) {
    return {position, normal, normal, u, v, t, rounding_error(position)};
}

/// Where a ray comes as near as `radius` to the origin and where it leaves, NaN where it does not.
/// `direction` may be zero. The discriminant comes from the ray's closest approach, and c as a
/// product: neither cancels for a ray far from a small circle or near a huge one.
std::array<double, 2> circle_crossings(const Vec3& origin, const Vec3& direction, double radius) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const double a = vec3_dot(direction, direction), b = vec3_dot(origin, direction);
    const Vec3 closest = vec3_sub(origin, vec3_scale(direction, b / a));
    const double discriminant = a * (square(radius) - vec3_dot(closest, closest));
    if (!(discriminant >= 0.0))
        return {none, none};
    const double distance = std::sqrt(vec3_dot(origin, origin));
    const double c = (distance - radius) * (distance + radius);
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const double first = q == 0.0 ? 0.0 : c / q, second = q / a;
    return {std::min(first, second), std::max(first, second)};
}

} // namespace

double SpherePrimitive::intersect(const Ray& ray) const {
    const Vec3 from_centre = vec3_sub(ray.origin, centre);
    for (const double t : circle_crossings(from_centre, ray.direction, radius))
        if (t > ray.t_near && t < ray.t_far)
            return t;
    return -1.0;
}

SurfaceHit SpherePrimitive::describe(const Ray& ray, double t) const {
    const Vec3 normal = vec3_normalise(vec3_sub(ray.at(t), centre));
    const Vec3 position = vec3_add(centre, vec3_scale(normal, radius));
    return flat_hit(position, normal, 0.0, 0.0, t);
}

void SpherePrimitive::set_parameters(SurfaceHit& hit) const {
    hit.u = azimuth_share(hit.normal.y, hit.normal.x);
    hit.v = std::acos(std::clamp(hit.normal.z, -1.0, 1.0)) / PI;
}

Box SpherePrimitive::bounds() const {
    const Vec3 r = vec3(radius, radius, radius);
    return {vec3_sub(centre, r), vec3_add(centre, r)};
}

RectanglePrimitive::RectanglePrimitive(const Vector3& centre_in, const Vector3& edge_u_in,
                                       const Vector3& edge_v_in)
    : centre(to_vec3(centre_in)), edge_u(to_vec3(edge_u_in)), edge_v(to_vec3(edge_v_in)) {
    normal = scaled_to_unit(vec3_cross(scaled_to_unit(edge_u), scaled_to_unit(edge_v)));
    const Vec3 across_u = vec3_cross(edge_v, normal), across_v = vec3_cross(normal, edge_u);
    dual_u = vec3_scale(across_u, 1.0 / vec3_dot(across_u, edge_u));
    dual_v = vec3_scale(across_v, 1.0 / vec3_dot(across_v, edge_v));
}

double RectanglePrimitive::intersect(const Ray& ray) const {
    const double t = intersect_plane(ray, centre, normal);
    if (t < 0.0)
        return -1.0;
    const Vec3 p = vec3_sub(ray.at(t), centre);
    // Rounding must not open a gap between rectangles that share an edge.
    constexpr double HALF = 0.5 + 1e-12;
    return std::fabs(vec3_dot(p, dual_u)) <= HALF && std::fabs(vec3_dot(p, dual_v)) <= HALF ? t
                                                                                            : -1.0;
}

SurfaceHit RectanglePrimitive::describe(const Ray& ray, double t) const {
    const Vec3 p = vec3_sub(ray.at(t), centre);
    const double u = std::clamp(vec3_dot(p, dual_u), -0.5, 0.5);
    const double v = std::clamp(vec3_dot(p, dual_v), -0.5, 0.5);
    const Vec3 offset = vec3_add(vec3_scale(edge_u, u), vec3_scale(edge_v, v));
    return flat_hit(vec3_add(centre, offset), normal, 0.0, 0.0, t);
}

void RectanglePrimitive::set_parameters(SurfaceHit& hit) const {
    const Vec3 p = vec3_sub(hit.position, centre);
    hit.u = std::clamp(vec3_dot(p, dual_u) + 0.5, 0.0, 1.0);
    hit.v = std::clamp(vec3_dot(p, dual_v) + 0.5, 0.0, 1.0);
}

Box RectanglePrimitive::bounds() const {
    const auto reach = [](double u, double v) { return 0.5 * (std::fabs(u) + std::fabs(v)); };
    const Vec3 r =
        vec3(reach(edge_u.x, edge_v.x), reach(edge_u.y, edge_v.y), reach(edge_u.z, edge_v.z));
    return {vec3_sub(centre, r), vec3_add(centre, r)};
}

DiskPrimitive::DiskPrimitive(const Vector3& centre_in, const Vector3& normal_in, double radius_in)
    : centre(to_vec3(centre_in)), normal(scaled_to_unit(to_vec3(normal_in))),
      tangent(any_perpendicular(normal)), radius(radius_in) {}

double DiskPrimitive::intersect(const Ray& ray) const {
    const double t = intersect_plane(ray, centre, normal);
    if (t < 0.0)
        return -1.0;
    const Vec3 p = vec3_sub(ray.at(t), centre);
    return vec3_dot(p, p) <= square(radius) ? t : -1.0;
}

SurfaceHit DiskPrimitive::describe(const Ray& ray, double t) const {
    const Vec3 p = vec3_sub(ray.at(t), centre);
    const Vec3 in_plane = vec3_sub(p, vec3_scale(normal, vec3_dot(p, normal)));
    return flat_hit(vec3_add(centre, in_plane), normal, 0.0, 0.0, t);
}

void DiskPrimitive::set_parameters(SurfaceHit& hit) const {
    const Vec3 p = vec3_sub(hit.position, centre);
    const double x = vec3_dot(p, tangent), y = vec3_dot(p, vec3_cross(normal, tangent));
    hit.u = std::min(std::hypot(x, y) / radius, 1.0);
    hit.v = azimuth_share(y, x);
}

Box DiskPrimitive::bounds() const {
    const auto reach = [&](double n) { return radius * std::sqrt(std::max(0.0, 1.0 - n * n)); };
    const Vec3 r = vec3(reach(normal.x), reach(normal.y), reach(normal.z));
    return {vec3_sub(centre, r), vec3_add(centre, r)};
}

CylinderPrimitive::CylinderPrimitive(const Vector3& from_in, const Vector3& to_in, double radius_in)
    : from(to_vec3(from_in)), radius(radius_in) {
    const Vec3 along = vec3_sub(to_vec3(to_in), from);
    axis = scaled_to_unit(along);
    length = vec3_dot(along, axis);
    tangent = any_perpendicular(axis);
}

double CylinderPrimitive::intersect(const Ray& ray) const {
    const auto across = [&](const Vec3& v) {
        return vec3_sub(v, vec3_scale(axis, vec3_dot(v, axis)));
    };
    const Vec3 from_end = vec3_sub(ray.origin, from);
    const Vec3 origin = across(from_end), direction = across(ray.direction);
    const double along = vec3_dot(from_end, axis), speed = vec3_dot(ray.direction, axis);
    for (const double t : circle_crossings(origin, direction, radius))
        if (t > ray.t_near && t < ray.t_far && along + t * speed >= 0.0 &&
            along + t * speed <= length)
            return t;
    return -1.0;
}

SurfaceHit CylinderPrimitive::describe(const Ray& ray, double t) const {
    const Vec3 p = vec3_sub(ray.at(t), from);
    const double along = vec3_dot(p, axis);
    const Vec3 normal = vec3_normalise(vec3_sub(p, vec3_scale(axis, along)));
    const Vec3 foot = vec3_add(from, vec3_scale(axis, std::clamp(along, 0.0, length)));
    return flat_hit(vec3_add(foot, vec3_scale(normal, radius)), normal, 0.0, 0.0, t);
}

void CylinderPrimitive::set_parameters(SurfaceHit& hit) const {
    const Vec3 p = vec3_sub(hit.position, from);
    hit.u = azimuth_share(vec3_dot(p, vec3_cross(axis, tangent)), vec3_dot(p, tangent));
    hit.v = std::clamp(vec3_dot(p, axis) / length, 0.0, 1.0);
}

Box CylinderPrimitive::bounds() const {
    const auto reach = [&](double a) { return radius * std::sqrt(std::max(0.0, 1.0 - a * a)); };
    const Vec3 r = vec3(reach(axis.x), reach(axis.y), reach(axis.z));
    const Vec3 to = vec3_add(from, vec3_scale(axis, length));
    const Vec3 low = vec3(std::min(from.x, to.x), std::min(from.y, to.y), std::min(from.z, to.z));
    const Vec3 high = vec3(std::max(from.x, to.x), std::max(from.y, to.y), std::max(from.z, to.z));
    return {vec3_sub(low, r), vec3_add(high, r)};
}

std::array<double, 2> TrianglePrimitive::barycentric(const Ray& ray,
                                                     std::array<double, 2> fallback) const {
    const Vec3 e1 = vec3_sub(corners[1], corners[0]), e2 = vec3_sub(corners[2], corners[0]);
    const Vec3 p = vec3_cross(ray.direction, e2);
    const double determinant = vec3_dot(e1, p);
    const Vec3 from_corner = vec3_sub(ray.origin, corners[0]);
    double u = vec3_dot(from_corner, p) / determinant;
    double v = vec3_dot(ray.direction, vec3_cross(from_corner, e1)) / determinant;
    if (!std::isfinite(u) || !std::isfinite(v)) {
        u = fallback[0];
        v = fallback[1];
    }
    u = std::clamp(u, 0.0, 1.0);
    return {u, std::clamp(v, 0.0, 1.0 - u)};
}

SurfaceHit TrianglePrimitive::describe(const Ray& ray, std::array<double, 2> barycentric) const {
    const Vec3 e1 = vec3_sub(corners[1], corners[0]), e2 = vec3_sub(corners[2], corners[0]);
    const Vec3 offset = vec3_add(vec3_scale(e1, barycentric[0]), vec3_scale(e2, barycentric[1]));
    const Vec3 position = vec3_add(corners[0], offset);
    const Vec3 normal = scaled_to_unit(vec3_cross(scaled_to_unit(e1), scaled_to_unit(e2)));
    SurfaceHit hit = flat_hit(position, normal, barycentric[0], barycentric[1], 0.0);
    hit.distance = vec3_dot(vec3_sub(position, ray.origin), ray.direction) /
                   vec3_dot(ray.direction, ray.direction);
    // Embree tests the next ray against this triangle in single precision, with corners relative
    // to the origin: an error of a few roundings of the largest such coordinate.
    double reach = 0.0;
    for (const Vec3& corner : corners)
        reach = std::max(reach, largest_component(vec3_sub(corner, position)));
    constexpr double INTERSECTION_ROUNDINGS = 6.0;
    hit.position_error += INTERSECTION_ROUNDINGS * FLOAT_ROUNDING * reach;
    return hit;
}

TrianglePrimitive triangle_of(const MeshShape& mesh, std::uint32_t triangle) {
    TrianglePrimitive primitive;
    for (std::size_t k = 0; k < 3; ++k) {
        const float* p =
            mesh.positions.data() + 3 * std::size_t{mesh.indices[3 * std::size_t{triangle} + k]};
        primitive.corners[k] = vec3(p[0], p[1], p[2]);
    }
    return primitive;
}

void interpolate_vertex_data(const MeshShape& mesh, std::uint32_t triangle,
                             std::array<double, 2> barycentric, const Placement* placement,
                             SurfaceHit& hit) {
    const std::array<double, 3> weights{1.0 - barycentric[0] - barycentric[1], barycentric[0],
                                        barycentric[1]};
    const auto sum = [&](const std::vector<float>& values, std::size_t width, std::size_t axis) {
        double total = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
            total += weights[k] *
                     static_cast<double>(
                         values[width * mesh.indices[3 * std::size_t{triangle} + k] + axis]);
        return total;
    };
    if (!mesh.texture_coordinates.empty()) {
        hit.u = sum(mesh.texture_coordinates, 2, 0);
        hit.v = sum(mesh.texture_coordinates, 2, 1);
    }
    if (mesh.normals.empty())
        return;
    const Vec3 own =
        vec3(sum(mesh.normals, 3, 0), sum(mesh.normals, 3, 1), sum(mesh.normals, 3, 2));
    const Vec3 shading = placement != nullptr ? placement->normal(own) : own;
    if (!(largest_component(shading) > 1e-12))
        return;
    hit.shading = scaled_to_unit(shading);
    if (vec3_dot(hit.shading, hit.normal) < 0.0)
        hit.shading = vec3_scale(hit.shading, -1.0);
}

} // namespace reradiant
