#pragma once

#include "host/fit/stack/stack_inversion.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace reradiant {

/// A stack as a function of its unknown numbers: logarithms of factors of thickness and absorption,
/// addends of IOR. All zero is the stack as given.
class UnknownStack {
public:
    UnknownStack(const LayerStack& stack, const UnknownLayers& unknown);

    Eigen::Index count() const { return static_cast<Eigen::Index>(numbers_.size()); }
    LayerStack stack(const Eigen::VectorXd& numbers) const;
    std::string name(Eigen::Index number) const;
    /// Returns the number's value in the units of a material file: the thickness, the factor of the
    /// absorption, the addend of the IOR.
    double value(Eigen::Index number, double at) const;
    /// Derivative of `value`.
    double slope(Eigen::Index number, double at) const;

private:
    enum class Kind { Thickness, Absorption, Ior };
    struct Number {
        Kind kind;
        std::size_t layer;
    };
    LayerStack given_;
    std::vector<Number> numbers_;
};

/// Numbers at which the blocks of some data agree best.
struct UnknownStackFit {
    Eigen::VectorXd numbers;
    Eigen::MatrixXd root; ///< covariance = root root^T over what the data determine
    StackEstimate estimate;
};

/// See invert_stack. weight: 1 / sigma^2 of every block. Input Error when there is one geometry
/// only or the stack has nothing of what is unknown; run-time Error when Ceres does not converge.
UnknownStackFit fit_unknown_stack(const UnknownStack& unknown, const BispectralData& data,
                                  const std::vector<Eigen::MatrixXd>& weight);

} // namespace reradiant
