#pragma once

#include "host/layers/sources/depth_cells.h"
#include "host/layers/stack/side.h"
#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <array>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace reradiant {

/// What a stack does at one wavelength to light that is sent out within it: by the depth cells of
/// its dyed slabs, from the air down, and by a diffuse substrate, which comes last. A cell sends
/// out its power the same in all directions, the substrate by the cosine. All interreflections
/// between the stack's parts are included, and what dyes and substrate absorb is lost here.
class SourceTransport {
public:
    /// Nodes on every piece of a quadrature over the cosine in air.
    static constexpr int escape_nodes = 48;

    virtual ~SourceTransport() = default;

    Eigen::Index sources() const { return exchange_.rows(); }
    /// (sources, sources): mean fluence in the row's cell, or irradiance on the substrate, per
    /// power that the column's source sends out.
    const Eigen::MatrixXd& exchange() const { return exchange_; }
    /// g by source: pi g times the radiance in air towards a direction is the source's power times
    /// what `reached` says of that direction (reciprocity). 4 n^2 of a cell, n^2 of the medium
    /// above the substrate.
    const Eigen::VectorXd& weights() const { return weights_; }
    /// Share of a source's power that is guided for ever by total reflection.
    const Eigen::VectorXd& guided() const { return guided_; }

    /// Mean fluence or irradiance at every source per flux that comes from the air in a direction.
    virtual Eigen::VectorXd reached(double cos_theta, Side from) const = 0;
    /// Share of every source's power that leaves into the air. It is integrated when it is first
    /// asked for.
    const Eigen::VectorXd& escaped(Side to) const;

protected:
    /// Integrates what `escaped` says.
    virtual Eigen::VectorXd integrate_escaped(Side to) const = 0;
    /// Does so from what reaches the sources, by quadrature over the cosine in air between
    /// `breaks`.
    Eigen::VectorXd escaped_by_reciprocity(const std::vector<double>& breaks, Side to) const;

    Eigen::MatrixXd exchange_;
    Eigen::VectorXd weights_, guided_;

private:
    struct Escaped {
        std::once_flag made;
        Eigen::VectorXd share;
    };
    mutable std::array<Escaped, 2> escaped_; ///< by side
};

/// Makes the transport of a stack whose slabs have `cells`. It ends in its lower face to the air or
/// in a diffuse substrate that is Lambertian. Input Error for numbers out of range.
std::shared_ptr<const SourceTransport> source_transport(const StackElements& stack,
                                                        const StackCells& cells);

} // namespace reradiant
