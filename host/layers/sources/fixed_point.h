#pragma once

#include <Eigen/Core>

#include <functional>

namespace reradiant {

/// Returns x = first + map(x) for a linear map, by GMRES without restarts (Saad and Schultz 1986):
/// the error falls fast where adding up the series would take thousands of terms. NaN where it does
/// not fall to 1e-13.
Eigen::VectorXd fixed_point(const Eigen::VectorXd& first,
                            const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& map);

} // namespace reradiant
