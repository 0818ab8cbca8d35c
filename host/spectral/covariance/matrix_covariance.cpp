#include "reradiant/reradiation.h"

#include <Eigen/Eigenvalues>
#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

/// Share of the variance that directions may hold and yet count as independent errors.
constexpr double least_variance = 1e-8;

std::string grid_text(const WavelengthGrid& grid) {
    return fmt::format("{} to {} nm in steps of {}", grid.centre_nm(0), grid.to_nm(), grid.step_nm);
}

void require_same_bands(const WavelengthGrid& of_matrix, const WavelengthGrid& of_covariance,
                        const char* axis) {
    const double rounding = 1e-6 * of_matrix.step_nm;
    if (of_matrix.count != of_covariance.count ||
        std::abs(of_matrix.from_nm - of_covariance.from_nm) > rounding ||
        std::abs(of_matrix.to_nm() - of_covariance.to_nm()) > rounding)
        throw std::invalid_argument(fmt::format("its {} bands are {}, those of the matrix {}", axis,
                                                grid_text(of_covariance), grid_text(of_matrix)));
}

} // namespace

Matrix MatrixCovariance::standard_errors() const {
    Matrix variance = independent.cwiseAbs2();
    if (directions.cols() > 0)
        variance.reshaped() += directions.rowwise().squaredNorm();
    return variance.cwiseSqrt();
}

MatrixCovariance independent_errors(const ReradiationMatrix& errors) {
    for (int i = 0; i < errors.excitation.count; ++i)
        for (int o = 0; o < errors.emission.count; ++o)
            if (errors.values(o, i) < 0.0)
                throw std::invalid_argument(
                    fmt::format("the standard error at emission {} nm, excitation {} nm is {}",
                                errors.emission.centre_nm(o), errors.excitation.centre_nm(i),
                                errors.values(o, i)));
    return {errors.emission, errors.excitation, Matrix(errors.values.size(), 0), errors.values};
}

MatrixCovariance in_fewer_directions(const MatrixCovariance& covariance) {
    MatrixCovariance fewer = covariance;
    const Matrix& all = covariance.directions;
    if (all.cols() == 0)
        return fewer;
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(all.transpose() * all);
    const Eigen::VectorXd variances = solver.eigenvalues().cwiseMax(0.0); // ascending
    Eigen::Index left_out = 0;
    for (double sum = 0.0; left_out < variances.size(); ++left_out)
        if ((sum += variances(left_out)) > least_variance * variances.sum())
            break;
    fewer.directions = all * solver.eigenvectors().rightCols(all.cols() - left_out);
    const Eigen::VectorXd rest =
        all.rowwise().squaredNorm() - fewer.directions.rowwise().squaredNorm();
    fewer.independent.reshaped() =
        (fewer.independent.reshaped().cwiseAbs2() + rest.cwiseMax(0.0)).cwiseSqrt();
    return fewer;
}

void require_covariance_of(const ReradiationMatrix& matrix, const MatrixCovariance& covariance) {
    require_same_bands(matrix.emission, covariance.emission, "emission");
    require_same_bands(matrix.excitation, covariance.excitation, "excitation");
    if (!covariance.matrix)
        return;
    constexpr double rounding = 1e-6;
    const double off = (*covariance.matrix - matrix.values).cwiseAbs().maxCoeff();
    if (!(off <= rounding * covariance.matrix->cwiseAbs().maxCoeff()))
        throw std::invalid_argument(
            fmt::format("it belongs to another matrix, whose entries differ by up to {:.2g}", off));
}

} // namespace reradiant
