#include "host/render/dyes/masked_factors.h"

#include "host/spectral/matrix/linear_systems.h"
#include "host/spectral/matrix/singular_values.h"

#include <cmath>
#include <utility>

namespace reradiant {

namespace {

/// Alternating least squares for the entries from an earlier lane to a later one.
class MaskedFit {
public:
    MaskedFit(const Eigen::MatrixXd& coupling, Eigen::Index lanes)
        : lanes_(lanes), channels_(coupling.rows() / lanes), lower_(coupling) {
        for (Eigen::Index row = 0; row < lower_.rows(); ++row)
            for (Eigen::Index column = 0; column < lower_.cols(); ++column)
                if (column % lanes_ >= row % lanes_)
                    lower_(row, column) = 0.0;
        svd_ = thin_svd(lower_);
        norm_ = lower_.norm();
    }

    double norm() const { return norm_; }

    /// Fits with so many terms, beginning with the largest singular vectors.
    ChannelFactors fit(int terms) const {
        constexpr int most_steps = 200;
        ChannelFactors factors;
        const Eigen::VectorXd roots = svd_.s.head(terms).cwiseSqrt();
        factors.sent = svd_.u.leftCols(terms) * roots.asDiagonal();
        factors.taken = svd_.v.leftCols(terms) * roots.asDiagonal();
        factors.error = error(factors);
        for (int step = 0; step < most_steps; ++step) {
            ChannelFactors next = factors;
            next.sent = solved(lower_, next.taken, true);
            next.taken = solved(lower_.transpose(), next.sent, false);
            next.error = error(next);
            const bool stands = !(next.error < 0.995 * factors.error);
            if (next.error < factors.error)
                factors = std::move(next);
            if (stands)
                break;
        }
        return factors;
    }

private:
    double error(const ChannelFactors& factors) const {
        double sum = 0.0;
        for (Eigen::Index row = 0; row < lower_.rows(); ++row)
            for (Eigen::Index column = 0; column < lower_.cols(); ++column)
                if (column % lanes_ < row % lanes_) {
                    const double rest =
                        lower_(row, column) - factors.sent.row(row).dot(factors.taken.row(column));
                    sum += rest * rest;
                }
        return norm_ > 0.0 ? std::sqrt(sum) / norm_ : 0.0;
    }

    /// Factors of the rows for given ones of the columns: of each lane those of the lanes before it
    /// count, or after it.
    Eigen::MatrixXd solved(const Eigen::MatrixXd& values, const Eigen::MatrixXd& other,
                           bool takes_earlier) const {
        const Eigen::Index terms = other.cols();
        Eigen::MatrixXd result = Eigen::MatrixXd::Zero(values.rows(), terms);
        Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(terms, terms);
        for (Eigen::Index step = 0; step < lanes_; ++step) {
            const Eigen::Index lane = takes_earlier ? step : lanes_ - 1 - step;
            Eigen::MatrixXd right(terms, channels_);
            for (Eigen::Index b = 0; b < channels_; ++b)
                right.col(b) = other.transpose() * values.row(b * lanes_ + lane).transpose();
            const double ridge = 1e-12 * gram.trace() + 1e-300;
            const Eigen::MatrixXd system = gram + ridge * Eigen::MatrixXd::Identity(terms, terms);
            const Eigen::MatrixXd own = left_quotient(system, right);
            for (Eigen::Index b = 0; b < channels_; ++b)
                result.row(b * lanes_ + lane) = own.col(b).transpose();
            for (Eigen::Index a = 0; a < channels_; ++a) {
                const auto row = other.row(a * lanes_ + lane);
                gram += row.transpose() * row;
            }
        }
        return result;
    }

    Eigen::Index lanes_, channels_;
    Eigen::MatrixXd lower_;
    ThinSvd svd_;
    double norm_ = 0.0;
};

} // namespace

ChannelFactors factorise_channels(const Eigen::MatrixXd& coupling, Eigen::Index lanes,
                                  int most_terms, double tolerance) {
    const MaskedFit fit(coupling, lanes);
    const Eigen::Index channels = coupling.rows() / lanes;
    ChannelFactors factors;
    factors.sent = factors.taken = Eigen::MatrixXd::Zero(coupling.rows(), 0);
    factors.error = fit.norm() > 0.0 ? 1.0 : 0.0;
    for (int terms = 1; terms <= most_terms && factors.error > tolerance; ++terms)
        factors = fit.fit(terms);
    factors.within.resize(channels * channels, lanes);
    for (Eigen::Index b = 0; b < channels; ++b)
        for (Eigen::Index a = 0; a < channels; ++a)
            for (Eigen::Index lane = 0; lane < lanes; ++lane)
                factors.within(b * channels + a, lane) =
                    coupling(b * lanes + lane, a * lanes + lane);
    return factors;
}

} // namespace reradiant
