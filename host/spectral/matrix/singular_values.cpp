#include "host/spectral/matrix/singular_values.h"

#include <Eigen/SVD>

namespace reradiant {

ThinSvd thin_svd(const Eigen::MatrixXd& matrix) {
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
    return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix) {
    return Eigen::BDCSVD<Eigen::MatrixXd>(matrix).singularValues();
}

} // namespace reradiant
