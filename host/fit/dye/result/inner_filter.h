#pragma once

#include "host/fit/dye/dye_model.h"

#include <Eigen/Core>

#include <optional>

namespace reradiant {

/// The usual correction of fluorescence for the light that a sample absorbs itself on the way in
/// and on the way out (front-face form: Lakowicz 2006, Principles of Fluorescence Spectroscopy,
/// section 2.9), of one smooth layer. What is absorbed on the way out is lost in it: it is not sent
/// out again. `depth`: of the dye at every band of the data's common grid.
struct InnerFilter {
    /// What a dye of yield 1 would show for one unit of emission in a band, (emission,
    /// excitation): only above the excitation, the emission's share not counted.
    Eigen::MatrixXd factor;
};

/// Returns the factor for one view. Nothing for views of the far side or of a hemisphere.
std::optional<InnerFilter> inner_filter(const LayerStack& stack, const DyeView& view,
                                        const Eigen::VectorXd& depth, const DyeProblem& problem);

/// Yield and emission of one dye of known depth by that correction.
struct CorrectedDye {
    double quantum_yield = 0.0;
    Eigen::VectorXd emission; ///< by emission band, sum 1
};

/// Returns what the correction makes of a block: every entry over its factor, averaged by weight.
CorrectedDye corrected_dye(const InnerFilter& filter, const DyeBlock& block,
                           const DyeProblem& problem);

} // namespace reradiant
