#pragma once

#include <Eigen/Core>

namespace reradiant {

/// Systems of linear equations by LU decomposition with partial pivoting (Eigen). There is one
/// place for all callers: the templates take seconds to compile.

/// Returns A^-1 B.
Eigen::MatrixXd left_quotient(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// Returns B A^-1.
Eigen::MatrixXd right_quotient(const Eigen::MatrixXd& b, const Eigen::MatrixXd& a);

} // namespace reradiant
