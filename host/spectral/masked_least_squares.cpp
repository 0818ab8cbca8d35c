#include "host/spectral/masked_least_squares.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <vector>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Matrix below_diagonal(const Matrix& square) {
    return square.triangularView<Eigen::StrictlyLower>();
}

/// Entries that a step takes below zero stop at zero and are no longer free.
void pin(const Matrix& factor, const Matrix& step, Matrix& free, Matrix& pinned) {
    for (Eigen::Index j = 0; j < factor.size(); ++j) {
        if (free.data()[j] > 0.0 && factor.data()[j] + step.data()[j] < 0.0) {
            free.data()[j] = 0.0;
            pinned.data()[j] = -factor.data()[j];
        }
    }
}

/// Makes both columns of each term equally long, which conditions the joint problem best.
void balance_terms(Matrix& emission, Matrix& excitation) {
    for (Eigen::Index k = 0; k < emission.cols(); ++k) {
        const double e = emission.col(k).norm(), x = excitation.col(k).norm();
        if (e > 0.0 && x > 0.0) {
            const double ratio = std::sqrt(x / e);
            emission.col(k) *= ratio;
            excitation.col(k) /= ratio;
        }
    }
}

/// One factor's entries that may move: not held at zero by a gradient that points below it.
Matrix free_entries(const Matrix& factor, const Matrix& gradient) {
    return ((factor.array() > 0.0) || (gradient.array() < 0.0)).cast<double>();
}

/// One damped Gauss-Newton step in all entries that are free. The normal equations have one small
/// block per emission band; those are eliminated, which leaves a system in the excitation only.
class DampedStep {
public:
    DampedStep(const Matrix& emission, const Matrix& excitation, const Matrix& residual)
        : e_(emission), x_(excitation), n_(emission.rows()), rank_(emission.cols()),
          residual_(residual) {
        gradient_e_ = residual * x_;
        gradient_x_ = residual.transpose() * e_;
        free_e_ = free_entries(e_, gradient_e_);
        free_x_ = free_entries(x_, gradient_x_);
    }

    /// Step to the bounded minimum of the damped quadratic model, nearly: entries that would
    /// turn negative are set to zero and the others solved again, a few times.
    void solve_bounded(double damping, Matrix& step_e, Matrix& step_x) {
        constexpr int rounds = 5;
        const Matrix free_e = free_e_, free_x = free_x_;
        const Matrix gradient_e = gradient_e_, gradient_x = gradient_x_;
        Matrix pinned_e = Matrix::Zero(n_, rank_), pinned_x = pinned_e;
        for (int round = 0; round < rounds; ++round) {
            solve(damping, step_e, step_x);
            step_e = step_e.cwiseProduct(free_e_) + pinned_e;
            step_x = step_x.cwiseProduct(free_x_) + pinned_x;
            if (((e_ + step_e).array() >= 0.0).all() && ((x_ + step_x).array() >= 0.0).all())
                break;
            pin(e_, step_e, free_e_, pinned_e);
            pin(x_, step_x, free_x_, pinned_x);
            const Matrix moved =
                residual_ + below_diagonal(pinned_e * x_.transpose() + e_ * pinned_x.transpose());
            gradient_e_ = moved * x_;
            gradient_x_ = moved.transpose() * e_;
        }
        free_e_ = free_e;
        free_x_ = free_x;
        gradient_e_ = gradient_e;
        gradient_x_ = gradient_x;
    }

    /// Largest entry of the gradient among free entries.
    double gradient_size() const {
        return std::max(gradient_e_.cwiseProduct(free_e_).cwiseAbs().maxCoeff(),
                        gradient_x_.cwiseProduct(free_x_).cwiseAbs().maxCoeff());
    }

    void solve(double damping, Matrix& step_e, Matrix& step_x) const {
        Matrix schur = excitation_blocks(damping);
        Vector right = Vector::Zero(n_ * rank_);
        for (Eigen::Index i = 0; i < n_; ++i)
            right.segment(i * rank_, rank_) =
                -gradient_x_.row(i).cwiseProduct(free_x_.row(i)).transpose();
        std::vector<Matrix> eliminated(static_cast<std::size_t>(n_));
        std::vector<Vector> eliminated_right(static_cast<std::size_t>(n_));
        Matrix sum_xx = Matrix::Zero(rank_, rank_);
        std::vector<Eigen::LLT<Matrix>> blocks(static_cast<std::size_t>(n_));
        for (Eigen::Index o = 0; o < n_; ++o) {
            const auto at = static_cast<std::size_t>(o);
            blocks[at].compute(masked_block(sum_xx, free_e_.row(o), damping));
            eliminated[at] = blocks[at].matrixL().solve(coupling(o));
            eliminated_right[at] = blocks[at].matrixL().solve(
                -gradient_e_.row(o).cwiseProduct(free_e_.row(o)).transpose());
            const Eigen::Index size = o * rank_;
            schur.topLeftCorner(size, size)
                .selfadjointView<Eigen::Lower>()
                .rankUpdate(eliminated[at].transpose(), -1.0);
            right.head(size).noalias() -= eliminated[at].transpose() * eliminated_right[at];
            sum_xx += x_.row(o).transpose() * x_.row(o);
        }
        const Vector solution = schur.selfadjointView<Eigen::Lower>().ldlt().solve(right);
        step_x = Eigen::Map<const Matrix>(solution.data(), rank_, n_).transpose();
        step_e.resize(n_, rank_);
        for (Eigen::Index o = 0; o < n_; ++o) {
            const auto at = static_cast<std::size_t>(o);
            step_e.row(o) =
                blocks[at]
                    .matrixU()
                    .solve(eliminated_right[at] - eliminated[at] * solution.head(o * rank_))
                    .transpose();
        }
    }

private:
    /// A diagonal block with the rows and columns of held entries replaced by the identity.
    Matrix masked_block(const Matrix& block, const Eigen::RowVectorXd& free, double damping) const {
        Matrix masked = free.asDiagonal() * block * free.asDiagonal();
        masked.diagonal().array() += damping + (1.0 - free.transpose().array());
        return masked;
    }

    Matrix excitation_blocks(double damping) const {
        Matrix blocks = Matrix::Zero(n_ * rank_, n_ * rank_);
        Matrix sum_ee = Matrix::Zero(rank_, rank_);
        for (Eigen::Index i = n_ - 1; i >= 0; --i) {
            blocks.block(i * rank_, i * rank_, rank_, rank_) =
                masked_block(sum_ee, free_x_.row(i), damping);
            sum_ee += e_.row(i).transpose() * e_.row(i);
        }
        return blocks;
    }

    /// Second derivatives between emission band o and every excitation band below it:
    /// rank x (o * rank).
    Matrix coupling(Eigen::Index o) const {
        Matrix result(rank_, o * rank_);
        for (Eigen::Index i = 0; i < o; ++i)
            result.middleCols(i * rank_, rank_) =
                free_e_.row(o).cwiseProduct(x_.row(i)).transpose() *
                free_x_.row(i).cwiseProduct(e_.row(o));
        return result;
    }

    const Matrix &e_, &x_;
    Eigen::Index n_, rank_;
    const Matrix& residual_;
    Matrix gradient_e_, gradient_x_, free_e_, free_x_;
};

} // namespace

Matrix MaskedLeastSquares::residual(const Matrix& emission, const Matrix& excitation) const {
    return below_diagonal(emission * excitation.transpose() - target);
}

double MaskedLeastSquares::cost(const Matrix& emission, const Matrix& excitation) const {
    return residual(emission, excitation).squaredNorm();
}

void MaskedLeastSquares::descend(Matrix& emission, Matrix& excitation, int sweeps) const {
    const Eigen::Index n = target.rows();
    Matrix rest = -residual(emission, excitation);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (Eigen::Index k = 0; k < emission.cols(); ++k) {
            auto e = emission.col(k);
            auto x = excitation.col(k);
            const Vector old_e = e, old_x = x;
            const Vector from_e = rest.triangularView<Eigen::StrictlyLower>() * x;
            double weight = 0.0;
            for (Eigen::Index o = 0; o < n; ++o) {
                e(o) = weight > 0.0 ? std::max(0.0, e(o) + from_e(o) / weight) : e(o);
                weight += x(o) * x(o);
            }
            rest.noalias() -= (e - old_e) * x.transpose();
            const Vector from_x = rest.transpose().triangularView<Eigen::StrictlyUpper>() * e;
            weight = 0.0;
            for (Eigen::Index i = n - 1; i >= 0; --i) {
                x(i) = weight > 0.0 ? std::max(0.0, x(i) + from_x(i) / weight) : x(i);
                weight += e(i) * e(i);
            }
            rest.noalias() -= e * (x - old_x).transpose();
        }
    }
}

void MaskedLeastSquares::polish(Matrix& emission, Matrix& excitation, int most_steps) const {
    constexpr int stall_window = 12;
    constexpr double stall_ratio = 0.999, exact = 1e-28;
    const double whole = below_diagonal(target).squaredNorm();
    balance_terms(emission, excitation);
    Matrix rest = residual(emission, excitation);
    double cost_now = rest.squaredNorm(), cost_before = cost_now;
    double damping = 1e-2 * std::max(emission.squaredNorm(), excitation.squaredNorm()) /
                     static_cast<double>(emission.rows() * emission.cols());
    for (int step = 0; step < most_steps && cost_now > exact * whole && damping < 1e12; ++step) {
        DampedStep system(emission, excitation, rest);
        if (!(system.gradient_size() > 0.0))
            return;
        Matrix step_e, step_x;
        bool improved = false;
        for (int attempt = 0; attempt < 12 && !improved; ++attempt) {
            system.solve_bounded(damping, step_e, step_x);
            const Matrix e = (emission + step_e).cwiseMax(0.0);
            const Matrix x = (excitation + step_x).cwiseMax(0.0);
            const Matrix trial = residual(e, x);
            improved = trial.squaredNorm() < cost_now;
            damping *= improved ? 0.3 : 4.0;
            if (improved) {
                emission = e;
                excitation = x;
                rest = trial;
                cost_now = rest.squaredNorm();
            }
        }
        if (!improved)
            return;
        if ((step + 1) % stall_window == 0) {
            if (cost_now > stall_ratio * cost_before)
                return;
            cost_before = cost_now;
        }
    }
}

} // namespace reradiant
