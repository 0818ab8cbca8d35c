#pragma once

#include <Eigen/Core>

namespace reradiant {

/// Thin singular value decomposition M = U diag(s) V^T, s descending. For (m, n): U (m, k), s (k),
/// V (n, k), k = min(m, n).
struct ThinSvd {
    Eigen::MatrixXd u;
    Eigen::VectorXd s;
    Eigen::MatrixXd v;
};

/// Decomposes a matrix by divide and conquer (Eigen). There is one place for all callers: the
/// template takes most of a minute to compile.
ThinSvd thin_svd(const Eigen::MatrixXd& matrix);

/// Singular values alone, descending.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix);

} // namespace reradiant
