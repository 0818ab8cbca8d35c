#include "host/scene/meshes/placement.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reradiant {

using namespace kernels;

namespace {

Vec3 row_of(const Eigen::Matrix3d& matrix, int row) {
    return vec3(matrix(row, 0), matrix(row, 1), matrix(row, 2));
}

Vec3 times(const std::array<Vec3, 3>& rows, const Vec3& v) {
    return vec3(vec3_dot(rows[0], v), vec3_dot(rows[1], v), vec3_dot(rows[2], v));
}

} // namespace

Placement::Placement(const std::array<double, 12>& given) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(given.data());
    const Eigen::Matrix3d linear = matrix.leftCols<3>();
    const double size = linear.norm(), volume = linear.determinant();
    if (!(std::abs(volume) > 1e-18 * size * size * size))
        throw std::invalid_argument("the transform makes the mesh flat");
    // The normals of a mirrored mesh stay on the side that its triangles face.
    const Eigen::Matrix3d inverse = linear.inverse();
    const Eigen::Matrix3d normals = inverse.transpose() * (volume < 0.0 ? -1.0 : 1.0);
    for (int k = 0; k < 3; ++k) {
        rows[static_cast<std::size_t>(k)] = row_of(linear, k);
        normal_rows[static_cast<std::size_t>(k)] = row_of(normals, k);
    }
    translation = vec3(matrix(0, 3), matrix(1, 3), matrix(2, 3));
    condition = size * inverse.norm();
}

Vec3 Placement::point(const Vec3& p) const {
    return vec3_add(times(rows, p), translation);
}

Vec3 Placement::normal(const Vec3& n) const {
    return times(normal_rows, n);
}

std::array<float, 12> Placement::matrix() const {
    const auto f = [](double x) { return static_cast<float>(x); };
    return {f(rows[0].x), f(rows[0].y), f(rows[0].z), f(translation.x),
            f(rows[1].x), f(rows[1].y), f(rows[1].z), f(translation.y),
            f(rows[2].x), f(rows[2].y), f(rows[2].z), f(translation.z)};
}

double Placement::rounding_at(const Vec3& place) const {
    const auto largest = [](const Vec3& v) {
        return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    };
    // A few roundings each of the place, of the translation and of their difference.
    constexpr double ROUNDINGS = 4.0, FLOAT_ROUNDING = 0x1p-24;
    return ROUNDINGS * FLOAT_ROUNDING * condition * (largest(place) + largest(translation));
}

} // namespace reradiant
