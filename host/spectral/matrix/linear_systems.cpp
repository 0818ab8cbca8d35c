#include "host/spectral/matrix/linear_systems.h"

#include <Eigen/LU>

namespace reradiant {

Eigen::MatrixXd left_quotient(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a.partialPivLu().solve(b);
}

Eigen::MatrixXd right_quotient(const Eigen::MatrixXd& b, const Eigen::MatrixXd& a) {
    return a.transpose().partialPivLu().solve(b.transpose()).transpose();
}

} // namespace reradiant
