#include "host/fit/result/error_bands.h"

#include "host/fit/solver/robust_loss.h"
#include "host/spectral/evidence/scatter_line.h"
#include "host/spectral/matrix/singular_values.h"

#include <Eigen/QR>
#include <ceres/loss_function.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double determined = 1e-7; ///< smallest share of the largest singular value
constexpr double held_beyond = 2.0; ///< standard errors
/// So many data an estimate of the noise from neighbours counts as beside the residuals, which say
/// little where nearly as many numbers are fitted as there are data.
constexpr double data_of_estimate = 16.0;

/// Weight that a robust loss leaves to every entry (iteratively reweighted least squares).
Matrix robust_weights(const Matrix& weighted_residual, RobustLoss loss) {
    const std::unique_ptr<ceres::LossFunction> function(make_loss(loss));
    Matrix weights = Matrix::Ones(weighted_residual.rows(), weighted_residual.cols());
    for (Eigen::Index k = 0; function && k < weights.size(); ++k) {
        double rho[3];
        function->Evaluate(weighted_residual(k) * weighted_residual(k), rho);
        weights(k) = std::sqrt(rho[1]);
    }
    return weights;
}

/// One row for every photon balance that is active at these sums.
Matrix balance_jacobian(const Matrix& entries, const FitTarget& target,
                        const PhotonPenalty& penalty, const Vector& sums) {
    const Eigen::Index bands = target.value.rows();
    Matrix rows(sums.size(), entries.cols());
    Eigen::Index active = 0;
    for (Eigen::Index i = 0; i < sums.size(); ++i) {
        const auto slopes = penalty.slopes(i, sums(i));
        if (const double weight = std::hypot(slopes[0], slopes[1]); weight > 0.0)
            rows.row(active++) =
                weight * target.photons.col(i).transpose() * entries.middleRows(i * bands, bands);
    }
    return rows.topRows(active);
}

/// Rows of used entries, weighted, and those of the photon balances.
Matrix data_jacobian(const Matrix& entries, const Matrix& weights, const Matrix& balances) {
    Matrix rows((weights.array() > 0.0).count() + balances.rows(), entries.cols());
    Eigen::Index next = 0;
    for (Eigen::Index k = 0; k < weights.size(); ++k)
        if (weights(k) > 0.0)
            rows.row(next++) = weights(k) * entries.row(k);
    rows.bottomRows(balances.rows()) = balances;
    return rows;
}

Matrix stacked_rows(const Matrix& above, const Matrix& below) {
    Matrix rows(above.rows() + below.rows(), below.cols());
    if (above.rows() > 0)
        rows.topRows(above.rows()) = above;
    rows.bottomRows(below.rows()) = below;
    return rows;
}

/// Weighted residuals of used entries in the order of data_jacobian, zero for its other rows.
Vector seen_residuals(const Matrix& residual, const Matrix& weights, const FitTarget& target,
                      Eigen::Index rows) {
    Vector seen = Vector::Zero(rows);
    Eigen::Index next = 0;
    for (Eigen::Index k = 0; k < residual.size(); ++k)
        if (target.weight(k) > 0.0)
            seen(next++) = residual(k) * weights(k) / target.weight(k);
    return seen;
}

/// Selects the diagonal from the entries in column-major order, (excitation bands, entries).
Matrix diagonal_gain(const FitTarget& target) {
    Matrix gain = Matrix::Zero(target.excitation.count, target.value.size());
    for (int i = 0; i < target.excitation.count; ++i)
        for (int o = 0; o < target.emission.count; ++o)
            if (on_diagonal(target.emission, o, target.excitation, i))
                gain(i, o + static_cast<Eigen::Index>(i) * target.emission.count) = 1.0;
    return gain;
}

/// Replaces the covariance of an estimate gain * entries, gain = C J^T W, by what shared errors of
/// the entries (in units of target.scale) make of it, with what has errors of its own beside them:
/// the prior and the photon balances.
void share_errors(const Matrix& entries, const Matrix& weights, const Matrix& beside,
                  const SharedErrors& errors, const FitTarget& target, double variance,
                  bool with_diagonal, Covariance& covariance) {
    const Vector squared = weights.cwiseAbs2().reshaped();
    const Matrix pull = squared.asDiagonal() * (entries * covariance.root);
    const Matrix of_parameters = covariance.root * pull.transpose() / (variance * target.scale);
    const Matrix gain =
        with_diagonal ? stacked_rows(of_parameters, diagonal_gain(target)) : of_parameters;
    const Matrix of_data = std::sqrt(variance) * errors.root(gain);
    const Matrix of_others = covariance.root * (beside * covariance.root).transpose();
    const Eigen::Index parameters = of_others.rows(), diagonal = of_data.rows() - parameters;
    covariance.diagonal_root = Matrix::Zero(diagonal, of_data.cols() + of_others.cols());
    covariance.diagonal_root.leftCols(of_data.cols()) = of_data.bottomRows(diagonal);
    covariance.root.resize(parameters, of_data.cols() + of_others.cols());
    covariance.root << of_data.topRows(parameters), of_others;
}

/// Columns of a Jacobian that are not held and not zero.
struct FreeColumns {
    std::vector<Eigen::Index> free;
    Vector lengths;
    Matrix triangle; ///< of a QR decomposition of these columns, scaled to length 1: the same
                     ///< singular values, but far fewer rows

    FreeColumns(const Matrix& jacobian, const std::vector<bool>& held) : columns_(jacobian.cols()) {
        for (Eigen::Index k = 0; k < jacobian.cols(); ++k)
            if (!held[static_cast<std::size_t>(k)] && jacobian.col(k).squaredNorm() > 0.0)
                free.push_back(k);
        Matrix scaled = jacobian(Eigen::all, free);
        lengths = scaled.colwise().norm().transpose();
        scaled *= lengths.cwiseInverse().asDiagonal();
        const auto count = static_cast<Eigen::Index>(free.size());
        triangle = Matrix::Zero(count, count);
        if (scaled.rows() <= count) {
            triangle.topRows(scaled.rows()) = scaled;
            return;
        }
        const Eigen::HouseholderQR<Eigen::Ref<Matrix>> qr(scaled);
        triangle = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
    }

    /// A row for each of these columns put where the column is, zero for the others.
    Matrix all_rows(const Matrix& rows) const {
        Matrix all = Matrix::Zero(columns_, rows.cols());
        for (std::size_t k = 0; k < free.size(); ++k)
            all.row(free[k]) = rows.row(static_cast<Eigen::Index>(k));
        return all;
    }

private:
    Eigen::Index columns_;
};

int determined_count(const Vector& singular_values) {
    return static_cast<int>((singular_values.array() > determined * singular_values(0)).count());
}

/// covariance_of data with a prior that every parameter has, so that all are determined: root =
/// inverse of the triangle. `free` and `rank` are of the data alone.
class Posterior {
public:
    Posterior(const Matrix& jacobian, const Matrix& prior, const std::vector<bool>& held)
        : data_(jacobian, held), prior_(prior), held_(held),
          rows_((data_.triangle * data_.lengths.asDiagonal()).transpose()) {}

    Covariance covariance(double variance) const {
        Covariance result;
        result.free = static_cast<int>(data_.free.size());
        if (result.free > 0)
            result.rank = determined_count(singular_values(data_.triangle));
        result.root = root(variance);
        return result;
    }

    /// Numbers that the data determine rather than the prior (MacKay 1992): trace of C J^T J.
    double effective_numbers(double variance) const {
        return (data_.all_rows(rows_).transpose() * root(variance)).squaredNorm() / variance;
    }

private:
    Matrix root(double variance) const {
        Matrix both(rows_.cols() + prior_.rows(), prior_.cols());
        both << data_.all_rows(rows_).transpose(), std::sqrt(variance) * prior_;
        const FreeColumns all(both, held_);
        const auto count = static_cast<Eigen::Index>(all.free.size());
        const Matrix inverse = all.triangle.triangularView<Eigen::Upper>().solve(
            Matrix(std::sqrt(variance) * Matrix::Identity(count, count)));
        return all.all_rows(all.lengths.cwiseInverse().asDiagonal() * inverse);
    }

    FreeColumns data_;
    const Matrix& prior_;
    const std::vector<bool>& held_;
    Matrix rows_; ///< transposed triangle of the data's free columns, not scaled
};

/// The curves normalised as FitResult has them, stacked into one vector: emission, then excitation.
Vector stacked(const FactorCurves& curves, const FitTarget& target) {
    const double steps = target.emission.step_nm / target.excitation.step_nm;
    Vector all(curves.emission.size() + curves.excitation.size());
    for (Eigen::Index k = 0; k < curves.emission.cols(); ++k) {
        const Eigen::Index rows = curves.emission.rows(), columns = curves.excitation.rows();
        const double sum = curves.emission.col(k).sum();
        all.segment(k * rows, rows) =
            curves.emission.col(k) / std::max(sum * target.emission.step_nm, 1e-300);
        all.segment(curves.emission.size() + k * columns, columns) =
            target.scale * steps * sum * curves.excitation.col(k);
    }
    return all;
}

} // namespace

std::vector<bool> firmly_at_zero(const NonNegativeModel& model, const Vector& parameters,
                                 const Vector& gradient, const Matrix& jacobian) {
    std::vector<bool> held;
    for (Eigen::Index k = 0; k < parameters.size(); ++k)
        held.push_back(!model.may_be_negative(k) && parameters(k) <= 0.0 &&
                       gradient(k) > held_beyond * jacobian.col(k).norm());
    return held;
}

Vector Covariance::sigma(const Matrix& jacobian) const {
    return (jacobian * root).rowwise().norm();
}

Covariance covariance_of(const Matrix& jacobian, const std::vector<bool>& held, double variance) {
    const FreeColumns columns(jacobian, held);
    const auto count = static_cast<Eigen::Index>(columns.free.size());
    Covariance result;
    result.free = static_cast<int>(count);
    result.root = Matrix::Zero(jacobian.cols(), 0);
    if (count == 0 || jacobian.rows() == 0)
        return result;
    const ThinSvd svd = thin_svd(columns.triangle);
    const Vector& values = svd.s;
    result.rank = determined_count(values);
    result.root = columns.all_rows(
        columns.lengths.cwiseInverse().asDiagonal() * svd.v.leftCols(result.rank) *
        (std::sqrt(variance) * values.head(result.rank).cwiseInverse()).asDiagonal());
    return result;
}

Covariance covariance_at(const TermModel& model, const ModelFit& fit, const FitTarget& target,
                         const PhotonPenalty& penalty, RobustLoss loss, bool noise_is_estimated,
                         const SharedErrors* errors, bool with_diagonal) {
    const Matrix entries = model.entry_jacobian(fit.parameters);
    const Matrix residual =
        (model.matrix(fit.parameters) - target.value).cwiseProduct(target.weight);
    const Matrix weights = target.weight.cwiseProduct(robust_weights(residual, loss));
    const Matrix balances = balance_jacobian(entries, target, penalty,
                                             target.photon_sums(model.matrix(fit.parameters)));
    const Matrix jacobian = data_jacobian(entries, weights, balances);
    const Vector seen = seen_residuals(residual, weights, target, jacobian.rows());
    const double used = (target.weight.array() > 0.0).cast<double>().sum();
    const std::vector<bool> held =
        firmly_at_zero(model, fit.parameters, jacobian.transpose() * seen, jacobian);
    const Matrix prior = model.prior_jacobian();
    const auto reduced = [&](double numbers) {
        return seen.squaredNorm() / std::max(1.0, used - numbers);
    };
    const auto variance_of = [&](double numbers) {
        return noise_is_estimated ? (data_of_estimate + seen.squaredNorm()) /
                                        (data_of_estimate + std::max(1.0, used - numbers))
                                  : std::max(1.0, reduced(numbers));
    };
    double numbers = static_cast<double>((fit.parameters.array() > 0.0).count());
    Covariance covariance;
    if (prior.rows() > 0) {
        const Posterior posterior(jacobian, prior, held);
        numbers = posterior.effective_numbers(noise_is_estimated ? reduced(numbers) : 1.0);
        covariance = posterior.covariance(variance_of(numbers));
    } else {
        covariance = covariance_of(jacobian, held, variance_of(numbers));
    }
    covariance.effective = numbers;
    if (errors != nullptr)
        share_errors(entries, weights, stacked_rows(prior, balances), *errors, target,
                     variance_of(numbers), with_diagonal, covariance);
    return covariance;
}

NormalisedCurves normalised_curves(const TermModel& model, const Vector& parameters,
                                   const Covariance& covariance, const FitTarget& target) {
    const FactorCurves curves = model.curves(parameters);
    const Vector value = stacked(curves, target);
    Matrix jacobian(value.size(), parameters.size());
    const double size = std::max(parameters.cwiseAbs().maxCoeff(), 1e-300);
    for (Eigen::Index k = 0; k < parameters.size(); ++k) {
        Vector moved = parameters;
        const double step = 1e-6 * std::max(std::abs(parameters(k)), 1e-3 * size);
        moved(k) += step;
        jacobian.col(k) = (stacked(model.curves(moved), target) - value) / step;
    }
    const Vector sigma = covariance.sigma(jacobian);
    const Eigen::Index split = curves.emission.size();
    const auto shaped = [](const Vector& list, Eigen::Index first, const Matrix& like) {
        return Matrix(Eigen::Map<const Matrix>(list.data() + first, like.rows(), like.cols()));
    };
    return {{shaped(value, 0, curves.emission), shaped(sigma, 0, curves.emission)},
            {shaped(value, split, curves.excitation), shaped(sigma, split, curves.excitation)}};
}

EmittedPhotons emitted_photons(const TermModel& model, const Vector& parameters,
                               const Matrix& jacobian, const Covariance& covariance,
                               const FitTarget& target) {
    const FactorCurves curves = model.curves(parameters);
    const Matrix photons = target.photons.cwiseProduct(target.allowed) * target.scale;
    EmittedPhotons emitted;
    emitted.share.resize(target.value.cols(), model.terms());
    for (int k = 0; k < model.terms(); ++k)
        emitted.share.col(k) = (curves.emission.col(k) * curves.excitation.col(k).transpose())
                                   .cwiseProduct(photons)
                                   .colwise()
                                   .sum()
                                   .transpose();
    emitted.sigma_of_sum = [&, photons](Eigen::Index term, const std::vector<Eigen::Index>& bands) {
        Vector slope = Vector::Zero(parameters.size());
        for (const Eigen::Index i : bands)
            slope += jacobian.middleRows(i * photons.rows(), photons.rows()).transpose() *
                     photons.col(i);
        // The terms share no parameter.
        for (Eigen::Index p = 0; p < slope.size(); ++p)
            if (model.term_of(p) != term)
                slope(p) = 0.0;
        return covariance.sigma(slope.transpose())(0);
    };
    return emitted;
}

} // namespace reradiant
