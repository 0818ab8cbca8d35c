#pragma once

#include "kernels/core/portable.h"

#include <array>

namespace reradiant {

/// Moves a mesh by the upper three rows of a matrix.
struct Placement {
    /// std::invalid_argument if the matrix leaves a mesh flat.
    explicit Placement(const std::array<double, 12>& rows);

    kernels::Vec3 point(const kernels::Vec3& p) const;
    /// The direction of a moved surface's normal: by the inverse transpose.
    kernels::Vec3 normal(const kernels::Vec3& n) const;
    std::array<float, 12> matrix() const;
    /// Bounds what Embree's rounding moves a surface by that rays find at a place: it takes rays to
    /// the mesh's own coordinates in single precision.
    double rounding_at(const kernels::Vec3& place) const;

    std::array<kernels::Vec3, 3> rows, normal_rows;
    kernels::Vec3 translation;
    double condition; ///< largest stretch over the smallest, at most
};

} // namespace reradiant
