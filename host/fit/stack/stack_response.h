#pragma once

#include "host/fit/result/shared_errors.h"
#include "reradiant/bispectral_data.h"
#include "reradiant/layer_stack.h"

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

/// A matrix and its errors.
struct BareMatrix {
    Eigen::MatrixXd value; ///< (emission, excitation), NaN where it was not measured
    /// Variance of an entry that comes from its own error of B. The rest is shared: it moves rows
    /// and columns as wholes, which sums of products of curves follow exactly, so that it must not
    /// weaken weights.
    Eigen::MatrixXd own_variance;
    SharedErrors errors; ///< all errors, without directions
    int guessed = 0;     ///< bands whose reflectance had to be guessed
};

/// M = B (I + diag(r) B)^-1 on the data's grids with first-order errors (dM = (I - M R) dB (I -
/// R M)). Entries that were not measured count as zero within and stay NaN, but those of the
/// diagonal as the reflectance of the nearest band that has one, which might be anything from 0 to
/// 1: how much of the light comes back a second time depends on it.
BareMatrix bare_matrix(const UncertainMatrix& under, const Eigen::VectorXd& r,
                       const BispectralData& data);

} // namespace reradiant
