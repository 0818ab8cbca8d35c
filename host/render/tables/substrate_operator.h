#pragma once

#include "reradiant/layer_stack.h"
#include "reradiant/wavelength_plan.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// A substrate's re-radiation on a plan's cells, ready to be put under a stack.
struct SubstrateOnCells {
    Eigen::MatrixXd
        fluorescence; ///< (cells, cells), rows = emission; empty if it does not re-radiate
    Eigen::MatrixXd emission, excitation; ///< (cells, K) masked factors; empty if kept dense
    bool is_factored() const { return fluorescence.size() > 0 && emission.cols() > 0; }
};

SubstrateOnCells substrate_on_cells(const Substrate& substrate, const WavelengthGrid& cells);

/// Returns re-radiation on a plan's cells, (cells, cells), as it is on the lanes, (lanes, lanes). A
/// line only excites: it has no width to emit into, and what it excites within its own cell stays
/// with it.
Eigen::MatrixXd cells_on_lanes(const Eigen::MatrixXd& cells, const WavelengthPlan& plan);
/// Returns slab_emission of a layer on the lanes, by phase: (lanes, lanes), rows = emission.
/// Without entries for a slab without dyes.
std::vector<Eigen::MatrixXd> dyes_on_lanes(const Layer& layer, const WavelengthPlan& plan);
/// Returns the substrate's own matrix on the lanes at a phase, its reflectance on the diagonal.
Eigen::MatrixXd substrate_on_lanes(const Substrate& substrate, const SubstrateOnCells& on_cells,
                                   const WavelengthPlan& plan, int phase);

/// The operator from what arrives at the substrate to what leaves it, all interreflections with
/// the stack counted, on the plan's lanes at one phase.
struct LaneOperator {
    Eigen::VectorXd diagonal;             ///< (lanes)
    Eigen::MatrixXd emission, excitation; ///< (lanes, K), masked factors of the lower triangle
    Eigen::MatrixXd dense;                ///< (lanes, lanes) off-diagonal part, when not factored
    Eigen::VectorXd row_sums() const;
};

/// scale * albedo M (I - diag(r) albedo M)^-1; r: share sent back by the stack, scale: factor of
/// each emission lane, both (lanes); albedo: factor of the whole matrix M.
LaneOperator lane_operator(const Substrate& substrate, const SubstrateOnCells& on_cells,
                           const WavelengthPlan& plan, int phase, double albedo,
                           const Eigen::VectorXd& r, const Eigen::VectorXd& scale);

} // namespace reradiant
