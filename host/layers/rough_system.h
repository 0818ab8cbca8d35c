#pragma once

#include "host/layers/interface_operator.h"
#include "host/layers/smooth_stack.h"
#include "host/layers/stack.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace reradiant {

/// True when an interface is treated as rough: it has a width, and the media differ by more than
/// the operators resolve (5e-5 of IOR; below that it neither reflects nor deflects visibly).
bool is_rough_interface(const StackValues& stack, std::size_t index);

/// What becomes of light that comes down to the first rough interface, by cell of its upper side,
/// and of light that the substrate emits; the substrate itself is black.
struct RoughResponse {
    Eigen::VectorXd to_substrate; ///< share that reaches the substrate
    Eigen::VectorXd to_air;       ///< share that leaves again into the air
    Eigen::VectorXd lost;         ///< share lost to single scattering
    double internal_reflectance = 0.0;
    double escape = 0.0; ///< share of the substrate's flux that leaves into the air
};

/// Adding on azimuthally averaged flux (Fourier order 0): the rough interfaces' operators with
/// smooth piles of media between them, solved for all interreflections at once by one LU of the
/// value function (the adjoint), on the cells of all rough interfaces' both sides.
class RoughSystem {
public:
    /// The first `count` layers of the stack; at least one of their interfaces is rough.
    RoughSystem(const StackValues& stack, std::size_t count);

    RoughResponse solve() const;
    /// Media and slabs from the air to the medium above the first rough interface.
    const SmoothStack& top() const { return piles_.front(); }
    const AngularGrid& top_grid() const { return rough_.front().upper; }
    /// Reflection lobe of the first rough interface, mean over each cell of its upper side. Only
    /// known for an interface towards a denser medium, else empty.
    const Eigen::VectorXd& first_lobe() const { return first_lobe_; }

private:
    /// A rough interface between its neighbours; `response`(i, j): share of cell j's flux that
    /// leaves through cell i; upper cells first, then lower ones.
    struct Rough {
        AngularGrid upper, lower;
        Eigen::MatrixXd response;
    };
    /// A pile of smooth interfaces between the cells of two grids.
    struct Pile {
        Eigen::MatrixXd down; ///< (lower cells, upper cells)
        Eigen::MatrixXd up;   ///< (upper cells, lower cells)
        Eigen::VectorXd back_up, back_down;
    };
    /// The piles at both ends: towards the air and towards the substrate.
    struct EndPile {
        Eigen::VectorXd through; ///< share of a cell's flux that gets out
        Eigen::VectorXd back;    ///< share that comes back
        Eigen::VectorXd emitted; ///< share of the substrate's emission that arrives at a cell
        double emitted_back = 0.0;
    };

    void add_rough(const StackValues& stack, std::size_t index);
    static Pile pile_between(const SmoothStack& media, const AngularGrid& upper,
                             const AngularGrid& lower);
    static EndPile air_pile(const SmoothStack& media, const AngularGrid& grid);
    static EndPile substrate_pile(const SmoothStack& media, const AngularGrid& grid);
    /// Values of outgoing flux as a linear function of the values of incoming flux.
    Eigen::MatrixXd coupling() const;
    Eigen::Index size() const;

    std::vector<SmoothStack> piles_;
    std::vector<Rough> rough_;
    std::vector<Pile> between_;
    EndPile air_, substrate_;
    Eigen::VectorXd first_lobe_;
    bool loses_ = false;
};

} // namespace reradiant
