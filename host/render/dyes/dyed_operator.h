#pragma once

#include "host/layers/sources/emitting_stack.h"
#include "host/render/dyes/masked_factors.h"
#include "host/render/tables/substrate_operator.h"
#include "reradiant/scene.h"
#include "reradiant/wavelength_plan.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace reradiant {

/// Light that a material with dyes in its slabs sends out again, on the lanes of one phase, as the
/// kernels have it:
///
/// f(wo, lo; wi, li) = sum over b, a of T_b(wo; lo) B(b lo, a li) T_a(wi; li),
///
/// with few channels a, b. T are the functions of the direction that best describe, at each
/// wavelength, what reaches the depth cells and the substrate (singular vectors).
struct ChannelOperator {
    /// By lane: what light from the nodes' directions brings to the channels, (TABLE_NODES,
    /// channels); of a sheet those below follow, (2 TABLE_NODES, channels).
    std::vector<Eigen::MatrixXd> reached;
    /// 1/sr, (channels * lanes, channels * lanes), lanes run fastest; rows = emission. Where
    /// factors stand for it, of the middle phase alone, by which components are chosen.
    Eigen::MatrixXd coupling;
    ChannelFactors factors; ///< of the coupling, without terms where it is applied as it is
};

/// Row of a node's direction on a side in ChannelOperator::reached.
Eigen::Index node_row(int node, Side side);

/// A material's dyes at every phase of a plan.
struct DyedOperator {
    int channels = 0;
    int cells = 0;              ///< of depth, the finest at any phase
    double depth_error = 0.0;   ///< EmittingStack::error, the largest
    double channel_error = 0.0; ///< share of what reaches the cells that no channel holds
    bool shifts_up = true;      ///< nothing is sent out below what excites it
    int terms = 0;              ///< most terms of a phase; 0: the coupling is applied as it is
    double factor_error = 0.0;  ///< what the terms leave out, the largest
    std::vector<ChannelOperator> phases;

    /// What reaches a channel at a node's direction on a side; 0 for a channel that a lane lacks.
    double reached(int phase, int lane, int node, int channel, Side side) const {
        const Eigen::MatrixXd& own =
            phases[static_cast<std::size_t>(phase)].reached[static_cast<std::size_t>(lane)];
        return channel < own.cols() ? own(node_row(node, side), channel) : 0.0;
    }
};

/// Returns a material's dyes from the disk cache (host/render/dyes/dyed_file.h), or computed and
/// then kept there. Thread-safe. Input Error at the material for what adding cannot do with dyes.
DyedOperator dyed_operator(const Material& material, const SubstrateOnCells& on_cells,
                           const WavelengthPlan& plan);

} // namespace reradiant
