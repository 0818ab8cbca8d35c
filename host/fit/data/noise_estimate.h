#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace reradiant {

/// Standard errors of the entries of a table.
struct EntryErrors {
    Eigen::MatrixXd value; ///< the data, with a mean where noise below zero was cut off
    Eigen::MatrixXd sigma; ///< of every entry, used or not; positive
    /// Standard deviation of what rounding does to neighbouring entries alike; zero where noise of
    /// half a step or more makes it different for each.
    Eigen::MatrixXd shared_rounding;
    double noise = 0.0;        ///< median of `sigma` over the used entries
    bool is_estimated = false; ///< no standard error came with the used entries
    std::vector<std::string> notes;
};

/// Standard errors of `value` (NaN: not measured): those given in `sigma` (NaN: unknown), else the
/// noise between neighbouring `used` entries; never less than what the rounding of the numbers does
/// or than a millionth of the largest used entry. Where an instrument cut off what is below zero,
/// the zeros among the noise become its mean: half of a normal noise lies 0.8 standard deviations
/// below zero on average.
EntryErrors entry_errors(const Eigen::MatrixXd& value, const Eigen::MatrixXd& sigma,
                         const Eigen::MatrixXd& used);

/// Standard error of a smooth matrix with the same noise everywhere, from the median of its mixed
/// second differences (1 -2 1) x (1 -2 1) over the places where all nine entries are `used`, or of
/// its mixed fourth differences where these see clearly less: both vanish for what is smooth enough
/// and have 36 and 4900 times the variance of an entry. Where fewer than 16 places can be looked
/// at, as with one or two columns, differences of second to eighth order along columns and what one
/// column is not of its neighbour. 0 where nothing can be looked at.
double estimated_noise(const Eigen::MatrixXd& value, const Eigen::MatrixXd& used);

/// Standard error of a smooth curve with the same noise everywhere (NaN: not measured), from the
/// medians of its differences of second to eighth order; 0 where nothing can be looked at.
double estimated_curve_noise(const Eigen::VectorXd& value);

} // namespace reradiant
