#pragma once

#include "host/fit/dye/dye_view.h"
#include "host/layers/sources/source_transport.h"
#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace reradiant {

/// What a stack does at one wavelength to its sources (SourceTransport), with a dye of some optical
/// depth in one of its slabs. n: sources.
struct DepthTransport {
    Eigen::MatrixXd exchange; ///< (n, n)
    Eigen::MatrixXd reached;  ///< (n, views): of the light that each view sends in
    /// (n, views): what each view sees of a source's power: a radiance factor (pi times the BSDF),
    /// or the share of the power that leaves.
    Eigen::MatrixXd seen;
};

/// A transport and its derivative by the dye's depth.
struct DepthTransportPair {
    DepthTransport value, slope;
};

/// The transport as a function of the dye's depth alone, by interpolation between Chebyshev's nodes
/// (Trefethen 2013, Approximation Theory and Approximation Practice): a fit asks for it at hundreds
/// of depths, and its derivative is exact for what is interpolated. The exchange between cells
/// grows as the logarithm of the depth where that goes to zero, but only times the depth does it
/// count; so nodes are dense there, and what is interpolated is nearly that product.
class DepthTable {
public:
    static constexpr int nodes = 32;

    /// `by_node`: transports with the dye's depth at each of node_depths(largest_depth).
    DepthTable(double largest_depth,
               std::span<const std::shared_ptr<const SourceTransport>> by_node,
               const std::vector<DyeView>& views);

    static std::vector<double> node_depths(double largest_depth);

    /// At a depth from 0; beyond the largest the transport is the largest's, with slope 0.
    DepthTransportPair at(double depth) const;

private:
    DepthTransport unpacked(const Eigen::VectorXd& packed) const;

    double largest_depth_;
    Eigen::Index sources_, views_;
    Eigen::MatrixXd coefficients_; ///< (packed numbers, nodes), of Chebyshev's polynomials
};

/// The elements of a stack with a dye's depth put into one slab.
StackElements with_dye(StackElements elements, std::size_t slab_element, double depth);

} // namespace reradiant
