#include "host/fit/result/shared_errors.h"

#include <Eigen/Cholesky>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

} // namespace

Matrix SharedErrors::entry_variance() const {
    Matrix sum = left.cwiseAbs2() * variance * right.cwiseAbs2();
    for (const Matrix& direction : directions)
        sum += direction.cwiseAbs2();
    return sum;
}

Matrix SharedErrors::root(const Matrix& gain) const {
    const Eigen::Index of_b = variance.size();
    Matrix spread(of_b + static_cast<Eigen::Index>(directions.size()), gain.rows());
    const Matrix sigma = variance.cwiseSqrt();
    for (Eigen::Index k = 0; k < gain.rows(); ++k) {
        const Matrix row = gain.row(k).reshaped(left.rows(), right.cols());
        spread.col(k).head(of_b) =
            (left.transpose() * row * right.transpose()).cwiseProduct(sigma).reshaped();
        for (std::size_t d = 0; d < directions.size(); ++d)
            spread(of_b + static_cast<Eigen::Index>(d), k) = row.cwiseProduct(directions[d]).sum();
    }
    // Far fewer columns than errors; semidefinite where quantities do not move.
    const Eigen::LDLT<Matrix> factors(spread.transpose() * spread);
    const Eigen::VectorXd lengths = factors.vectorD().cwiseMax(0.0).cwiseSqrt();
    const Matrix lower = Matrix(factors.matrixL()) * lengths.asDiagonal();
    return factors.transpositionsP().transpose() * lower;
}

} // namespace reradiant
