#include "host/fit/factors/factor_start.h"

#include "host/fit/models/run_in_parallel.h"
#include "host/spectral/matrix/singular_values.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int sweeps_of_a_start = 150;
/// Random guesses that are descended from; a descent costs a hundredth of a fit, and with three
/// terms of noisy data one in three ends in a worse valley (PHP8HP1C).
constexpr int random_guesses = 12;

/// Non-negative double SVD: of each singular pair the sign that carries more energy. Entries that
/// are not used count as zero; the descent that follows forgets them.
FactorCurves singular_start(const Matrix& value, int rank) {
    const ThinSvd svd = thin_svd(value);
    FactorCurves start{Matrix::Zero(value.rows(), rank), Matrix::Zero(value.cols(), rank)};
    for (int k = 0; k < rank && k < svd.s.size(); ++k) {
        const Vector u = svd.u.col(k), v = svd.v.col(k);
        const Vector up = u.cwiseMax(0.0), vp = v.cwiseMax(0.0);
        const Vector um = (-u).cwiseMax(0.0), vm = (-v).cwiseMax(0.0);
        const bool plus = up.norm() * vp.norm() >= um.norm() * vm.norm();
        const double scale = std::sqrt(svd.s(k));
        start.emission.col(k) = scale * (plus ? up : um);
        start.excitation.col(k) = scale * (plus ? vp : vm);
    }
    // Zeros are traps for alternating updates.
    start.emission.array() += 1e-3 * start.emission.mean() + 1e-12;
    start.excitation.array() += 1e-3 * start.excitation.mean() + 1e-12;
    return start;
}

FactorCurves grown_start(const FitTarget& target, const FactorCurves& smaller) {
    const Matrix known = (target.weight.array() > 0.0).cast<double>();
    const Matrix rest = (target.value - smaller.emission * smaller.excitation.transpose())
                            .cwiseProduct(known)
                            .cwiseMax(0.0);
    const FactorCurves term = singular_start(rest, 1);
    const Eigen::Index rank = smaller.emission.cols() + 1;
    FactorCurves start{Matrix(rest.rows(), rank), Matrix(rest.cols(), rank)};
    start.emission << smaller.emission, term.emission;
    start.excitation << smaller.excitation, term.excitation;
    return start;
}

FactorCurves random_start(const FitTarget& target, int rank, std::mt19937& random) {
    const double size = std::sqrt(target.value.cwiseAbs().mean() * 4.0 / rank) + 1e-6;
    FactorCurves start{Matrix(target.value.rows(), rank), Matrix(target.value.cols(), rank)};
    for (Matrix* factor : {&start.emission, &start.excitation})
        for (double& entry : factor->reshaped())
            entry = size * static_cast<double>(random()) * 0x1.0p-32; // the same in any library
    return start;
}

/// max(0, optimum) of one column of a factor, from the weighted residual with the column put back.
Vector optimal_column(const Matrix& squared_weight, const Matrix& residual, const Vector& mine,
                      const Vector& other) {
    const Vector curvature = squared_weight * other.cwiseAbs2();
    const Vector pull = squared_weight.cwiseProduct(residual) * other;
    Vector result = mine;
    for (Eigen::Index k = 0; k < mine.size(); ++k)
        result(k) = curvature(k) > 0.0 ? std::max(0.0, mine(k) + pull(k) / curvature(k)) : 0.0;
    return result;
}

} // namespace

double descend_factors(const FitTarget& target, FactorCurves& curves, int sweeps) {
    const Matrix squared = target.weight.cwiseAbs2();
    const Matrix transposed = squared.transpose();
    Matrix residual = target.value - curves.emission * curves.excitation.transpose();
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (Eigen::Index k = 0; k < curves.emission.cols(); ++k) {
            const Vector e = curves.emission.col(k), x = curves.excitation.col(k);
            const Vector better_e = optimal_column(squared, residual, e, x);
            // A term that died would never come back.
            if (better_e.maxCoeff() <= 0.0)
                continue;
            residual -= (better_e - e) * x.transpose();
            curves.emission.col(k) = better_e;
            const Vector better_x = optimal_column(transposed, residual.transpose(), x, better_e);
            if (better_x.maxCoeff() <= 0.0)
                continue;
            residual -= better_e * (better_x - x).transpose();
            curves.excitation.col(k) = better_x;
        }
    return target.chi_squared(curves.emission * curves.excitation.transpose());
}

std::vector<FactorCurves> factor_starts(const FitTarget& target, int rank,
                                        const FactorCurves& smaller, int starts, unsigned seed,
                                        int threads) {
    std::mt19937 random(seed + static_cast<unsigned>(rank));
    std::vector<FactorCurves> list{singular_start(target.value, rank)};
    if (smaller.emission.cols() == rank - 1 && rank > 1)
        list.push_back(grown_start(target, smaller));
    for (int guess = 0; rank > 1 && guess < random_guesses; ++guess)
        list.push_back(random_start(target, rank, random));
    std::vector<double> costs(list.size());
    run_in_parallel(threads, list.size(), [&](std::size_t k) {
        costs[k] = descend_factors(target, list[k], sweeps_of_a_start);
    });
    std::vector<std::size_t> order(list.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
    std::vector<FactorCurves> sorted;
    for (std::size_t k = 0; k < order.size() && static_cast<int>(k) < std::max(1, starts); ++k)
        sorted.push_back(list[order[k]]);
    return sorted;
}

Matrix coefficients_near(const SmoothBasis& basis, const Matrix& curves) {
    if (basis.is_per_band())
        return curves;
    constexpr int sweeps = 300;
    const Matrix gram = basis.values.transpose() * basis.values;
    const Matrix pull = basis.values.transpose() * curves;
    Matrix coefficients = Matrix::Zero(gram.rows(), curves.cols());
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (Eigen::Index j = 0; j < gram.rows(); ++j) {
            const Eigen::RowVectorXd step =
                (pull.row(j) - gram.row(j) * coefficients) / std::max(gram(j, j), 1e-12);
            coefficients.row(j) = (coefficients.row(j) + step).cwiseMax(0.0);
        }
    return coefficients;
}

} // namespace reradiant
