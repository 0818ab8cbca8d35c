#pragma once

#include <Eigen/Core>

namespace reradiant {

/// A coupling between several channels at each of several lanes, lanes running fastest, of which
/// nothing goes to a lane before the one that it comes from: within lanes, and as a sum of products
/// of what is sent and what is taken,
///
/// C(b o, a i) = within(b, a; o) [o = i] + sum over r of sent_r(b o) taken_r(a i) [o > i].
///
/// Applying it takes a running sum over the lanes for each term.
struct ChannelFactors {
    Eigen::MatrixXd within;      ///< (channels * channels, lanes), row b * channels + a
    Eigen::MatrixXd sent, taken; ///< (channels * lanes, terms)
    double error =
        0.0; ///< Frobenius norm of what they leave out over that of what is between lanes

    Eigen::Index terms() const { return sent.cols(); }
};

/// Finds as few terms as leave out no more than a tolerance, at most `most_terms`, by alternating
/// least squares on the entries below the diagonal. What lies above it is not looked at.
ChannelFactors factorise_channels(const Eigen::MatrixXd& coupling, Eigen::Index lanes,
                                  int most_terms, double tolerance);

} // namespace reradiant
