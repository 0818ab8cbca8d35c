#include "host/fit/models/matrix_fit.h"

#include "host/fit/models/matrix_model.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;
using Cholesky = Eigen::SimplicialLDLT<Sparse>;

/// Second differences from the peak itself down to 3e-4 of it, in steps of half a decade.
constexpr double first_precision = 1.0, precision_step = 10.0;
constexpr int most_precisions = 8;

Sparse diagonal_matrix(const Vector& values) {
    Sparse result(values.size(), values.size());
    result.reserve(Eigen::VectorXi::Constant(values.size(), 1));
    for (Eigen::Index k = 0; k < values.size(); ++k)
        result.insert(k, k) = values(k);
    return result;
}

/// -2 log evidence of a smoothness, up to a constant; infinite where it cannot be computed.
double evidence_cost(const FitTarget& target, const Smoothness& smoothness) {
    const PhotonPenalty no_penalty(target);
    const MatrixModel model(target, smoothness, no_penalty, RobustLoss::None);
    const Vector weights = model.weights(), values = model.values();
    const Sparse prior = model.prior();
    const Cholesky of_prior(prior),
        of_posterior(Sparse(prior + diagonal_matrix(weights.cwiseAbs2())));
    if (of_prior.info() != Eigen::Success || of_posterior.info() != Eigen::Success)
        return std::numeric_limits<double>::infinity();
    const Vector mode = of_posterior.solve(weights.cwiseAbs2().cwiseProduct(values).eval());
    const double misfit = (mode - values).cwiseProduct(weights).squaredNorm();
    return misfit + mode.dot(prior * mode) + of_posterior.vectorD().array().log().sum() -
           of_prior.vectorD().array().log().sum();
}

/// Most evidence over a ladder of precisions, first the same both ways, then one way at a time.
Smoothness best_smoothness(const FitTarget& target) {
    Smoothness best;
    double lowest = std::numeric_limits<double>::infinity();
    const auto consider = [&](const Smoothness& smoothness) {
        const double cost = evidence_cost(target, smoothness);
        if (cost < lowest) {
            lowest = cost;
            best = smoothness;
            return true;
        }
        return false;
    };
    double precision = first_precision;
    for (int k = 0; k < most_precisions; ++k, precision *= precision_step)
        consider({precision, precision});
    for (double Smoothness::*way : {&Smoothness::emission, &Smoothness::excitation})
        for (const double factor : {precision_step, 1.0 / precision_step}) {
            Smoothness next = best;
            do
                next.*way *= factor;
            while (consider(next));
        }
    return best;
}

/// Posterior at the mode: entries that are firmly at zero are held there.
class Posterior {
public:
    Posterior(const MatrixModel& model, const Vector& parameters)
        : position_(static_cast<std::size_t>(model.count()), -1) {
        const Vector squared = model.weights().cwiseAbs2();
        const Sparse precision = model.prior() + diagonal_matrix(squared);
        const Vector gradient = precision * parameters - squared.cwiseProduct(model.values());
        for (Eigen::Index k = 0; k < parameters.size(); ++k) {
            const double firm = 2.0 * std::sqrt(precision.coeff(k, k));
            if (parameters(k) > 0.0 || gradient(k) < firm) {
                position_[static_cast<std::size_t>(k)] = static_cast<Eigen::Index>(free_.size());
                free_.push_back(k);
            }
        }
        factor_ = std::make_unique<Cholesky>(restricted(precision));
        spread(squared);
    }

    /// Variance of every parameter, zero where held.
    Vector variances() const {
        Vector all = Vector::Zero(static_cast<Eigen::Index>(position_.size()));
        for (std::size_t k = 0; k < free_.size(); ++k)
            all(free_[k]) = variance_(static_cast<Eigen::Index>(k));
        return all;
    }
    double variance_of(const Vector& slope) const {
        Vector mine(static_cast<Eigen::Index>(free_.size()));
        for (std::size_t k = 0; k < free_.size(); ++k)
            mine(static_cast<Eigen::Index>(k)) = slope(free_[k]);
        return mine.dot(factor_->solve(mine));
    }
    double effective_numbers() const { return effective_; }

private:
    Sparse restricted(const Sparse& precision) const {
        std::vector<Eigen::Triplet<double>> entries;
        for (Eigen::Index column = 0; column < precision.outerSize(); ++column)
            for (Sparse::InnerIterator entry(precision, column); entry; ++entry) {
                const Eigen::Index a = position_[static_cast<std::size_t>(entry.row())];
                const Eigen::Index b = position_[static_cast<std::size_t>(entry.col())];
                if (a >= 0 && b >= 0)
                    entries.emplace_back(static_cast<int>(a), static_cast<int>(b), entry.value());
            }
        const auto n = static_cast<Eigen::Index>(free_.size());
        Sparse result(n, n);
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

    /// Diagonal of the inverse, some columns at a time.
    void spread(const Vector& squared_weights) {
        constexpr Eigen::Index at_once = 64;
        const auto n = static_cast<Eigen::Index>(free_.size());
        variance_.resize(n);
        for (Eigen::Index first = 0; first < n; first += at_once) {
            const Eigen::Index count = std::min(at_once, n - first);
            Matrix units = Matrix::Zero(n, count);
            for (Eigen::Index k = 0; k < count; ++k)
                units(first + k, k) = 1.0;
            const Matrix columns = factor_->solve(units);
            for (Eigen::Index k = 0; k < count; ++k)
                variance_(first + k) = columns(first + k, k);
        }
        for (Eigen::Index k = 0; k < n; ++k)
            effective_ += squared_weights(free_[static_cast<std::size_t>(k)]) * variance_(k);
    }

    std::vector<Eigen::Index> free_, position_;
    std::unique_ptr<Cholesky> factor_;
    Vector variance_;
    double effective_ = 0.0;
};

} // namespace

MatrixFit fit_matrix(const FitTarget& target, const FitSettings& settings, bool noise_is_estimated,
                     std::chrono::steady_clock::time_point begin) {
    const Smoothness smoothness = best_smoothness(target);
    PhotonPenalty penalty(target);
    auto model = std::make_shared<MatrixModel>(target, smoothness, penalty, settings.loss);
    MatrixFit result;
    const Vector start = model->values().cwiseMax(0.0);
    result.fit = minimise_within_budget(*model, target, penalty, start, settings.solver, begin);
    const auto posterior = std::make_shared<Posterior>(*model, result.fit.parameters);
    result.effective_numbers = posterior->effective_numbers();
    const double freedom =
        std::max(1.0, static_cast<double>(target.used_count()) - result.effective_numbers);
    const double reduced = result.fit.chi_squared / freedom;
    const double scale = std::sqrt(noise_is_estimated ? reduced : std::max(1.0, reduced));
    result.value = model->matrix(result.fit.parameters);
    result.sigma = scale * model->matrix(posterior->variances().cwiseMax(0.0).cwiseSqrt());
    result.stored_numbers = model->stored_numbers();
    result.emitted.share = target.scale * target.photon_sums(result.value);
    result.emitted.sigma_of_sum = [=, &target](Eigen::Index,
                                               const std::vector<Eigen::Index>& bands) {
        Matrix slope = Matrix::Zero(target.value.rows(), target.value.cols());
        for (const Eigen::Index i : bands)
            slope.col(i) = target.scale * target.photons.col(i);
        return scale * std::sqrt(posterior->variance_of(
                           model->gathered(slope.cwiseProduct(target.allowed))));
    };
    return result;
}

} // namespace reradiant
