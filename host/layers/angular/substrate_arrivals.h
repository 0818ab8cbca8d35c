#pragma once

#include "reradiant/stack_elements.h"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace reradiant {

/// Directions in which light arrives at the substrate of a stack that spreads it, from the cosines
/// in air that are nodes of kernels/scatter/oren_nayar_shape.h, as walks through the stack find
/// them. Absorption and thin films are left out, which hardly change these directions; IORs and
/// depths of scattering are rounded, so that a dispersive material needs few of these. Means are
/// good to some 0.1 %.
class SubstrateArrivals {
public:
    /// Returns those of a stack, made once and shared; thread-safe.
    static std::shared_ptr<const SubstrateArrivals> of(std::span<const StackElement> stack);

    /// Returns the mean over the light from a node of the azimuthal mean of pi f / rho of an
    /// Oren-Nayar substrate, between what arrives and a cosine in the lowest medium; unit 1.
    double mean_value(std::size_t node, double sigma, double cosine) const;
    /// Returns the mean of pi f / rho over the light from two nodes, as the table that
    /// oren_nayar_spread_value in kernels/scatter/oren_nayar_shape.h reads.
    std::vector<float> spread_values(double sigma) const;

    /// Cells of the cosine at the substrate.
    static constexpr std::size_t cells = 48;
    /// Orders of the azimuth's Fourier series in max(0, cos phi): 0, 1 and the even ones up to 32.
    static constexpr std::size_t orders = 18;

private:
    explicit SubstrateArrivals(const std::vector<StackElement>& stack);

    struct FromNode {
        std::array<double, cells> cosine{}; ///< mean of each cell; 0 where nothing arrives
        /// Means over all that arrives of sin cos(m azimuth), by order and cell.
        std::array<std::array<double, cells>, orders> sines{};
    };
    class Sums;
    static std::array<double, orders> mean_orders(const FromNode& i, const FromNode& o);

    std::vector<FromNode> nodes_;
};

} // namespace reradiant
