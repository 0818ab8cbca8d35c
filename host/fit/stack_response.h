#pragma once

#include "host/fit/bispectral_data.h"
#include "host/layers/stack.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// The bands of a square grid that holds both grids of some data. Input Error with the data's file
/// when their steps or phases disagree.
WavelengthGrid common_grid(const BispectralData& data);

/// Model B of a stack for the geometries of some data.
struct StackResponse {
    Eigen::VectorXd internal_reflectance; ///< r of every band of the common grid
    /// T_up(lo) T_down(li) / n_k(lo)^2 of every block, (emission, excitation).
    std::vector<Eigen::MatrixXd> gain;
};
StackResponse stack_response(const LayerStack& stack, const BispectralData& data);

/// One matrix with its variances.
struct UncertainMatrix {
    Eigen::MatrixXd value, variance;
};

/// B, the weighted mean of block / gain, (emission, excitation); NaN where no block was measured.
/// weight: 1 / sigma^2 of every block, 0 where not measured.
UncertainMatrix under_the_stack(const BispectralData& data, const StackResponse& response,
                                const std::vector<Eigen::MatrixXd>& weight);

/// M = B (I + diag(r) B)^-1 on the data's grids with first-order variances (dM = (I - M R) dB (I -
/// R M)). Entries that were not measured count as zero within and stay NaN.
UncertainMatrix bare_matrix(const UncertainMatrix& under, const Eigen::VectorXd& r,
                            const BispectralData& data);

} // namespace reradiant
