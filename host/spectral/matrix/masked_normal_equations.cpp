#include "host/spectral/matrix/masked_normal_equations.h"

#include <Eigen/Cholesky>

#include <vector>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Row = Eigen::RowVectorXd;

Matrix damped_block(const Matrix& block, const Row& scale, const Row& added) {
    Matrix result = scale.asDiagonal() * block * scale.asDiagonal();
    result.diagonal() += added.transpose();
    return result;
}

/// Second derivatives by excitation: block diagonal, (bands K) x (bands K).
Matrix excitation_blocks(const Matrix& e, const Matrix& scale, const Matrix& added) {
    const Eigen::Index n = e.rows(), rank = e.cols();
    Matrix blocks = Matrix::Zero(n * rank, n * rank);
    Matrix sum_ee = Matrix::Zero(rank, rank);
    for (Eigen::Index i = n - 1; i >= 0; --i) {
        blocks.block(i * rank, i * rank, rank, rank) =
            damped_block(sum_ee, scale.row(i), added.row(i));
        sum_ee += e.row(i).transpose() * e.row(i);
    }
    return blocks;
}

/// Second derivatives between emission band o and all excitation bands below it: K x (o K).
Matrix coupling(const FactorPair& factors, const FactorPair& scale, Eigen::Index o) {
    const Eigen::Index rank = factors.emission.cols();
    Matrix result(rank, o * rank);
    for (Eigen::Index i = 0; i < o; ++i)
        result.middleCols(i * rank, rank) =
            scale.emission.row(o).cwiseProduct(factors.excitation.row(i)).transpose() *
            scale.excitation.row(i).cwiseProduct(factors.emission.row(o));
    return result;
}

} // namespace

FactorPair solve_normal_equations(const FactorPair& factors, const FactorPair& scale,
                                  const FactorPair& added, const FactorPair& gradient) {
    const Eigen::Index n = factors.emission.rows(), rank = factors.emission.cols();
    const auto bands = static_cast<std::size_t>(n);
    Matrix schur = excitation_blocks(factors.emission, scale.excitation, added.excitation);
    Vector right = -gradient.excitation.transpose().reshaped();
    std::vector<Eigen::LLT<Matrix>> blocks(bands);
    std::vector<Matrix> eliminated(bands);
    std::vector<Vector> eliminated_right(bands);
    Matrix sum_xx = Matrix::Zero(rank, rank);
    for (Eigen::Index o = 0; o < n; ++o) {
        const auto at = static_cast<std::size_t>(o);
        const Eigen::Index size = o * rank;
        blocks[at].compute(damped_block(sum_xx, scale.emission.row(o), added.emission.row(o)));
        eliminated[at] = blocks[at].matrixL().solve(coupling(factors, scale, o));
        eliminated_right[at] = blocks[at].matrixL().solve(-gradient.emission.row(o).transpose());
        schur.topLeftCorner(size, size)
            .selfadjointView<Eigen::Lower>()
            .rankUpdate(eliminated[at].transpose(), -1.0);
        right.head(size).noalias() -= eliminated[at].transpose() * eliminated_right[at];
        sum_xx += factors.excitation.row(o).transpose() * factors.excitation.row(o);
    }
    const Vector solution = schur.selfadjointView<Eigen::Lower>().ldlt().solve(right);
    FactorPair step{Matrix(n, rank), solution.reshaped(rank, n).transpose()};
    for (Eigen::Index o = 0; o < n; ++o) {
        const auto at = static_cast<std::size_t>(o);
        const Vector rest = eliminated_right[at] - eliminated[at] * solution.head(o * rank);
        step.emission.row(o) = blocks[at].matrixU().solve(rest).transpose();
    }
    return step;
}

} // namespace reradiant
