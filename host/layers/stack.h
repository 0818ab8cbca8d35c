#pragma once

#include "host/spectral/spectrum.h"

#include <vector>

namespace reradiant {

enum class Distribution { Blinn, Beckmann, Ggx };
enum class Scattering { Multiple, Single };

/// The kernels' number of a distribution, MICROFACET_*.
int kernel_distribution(Distribution distribution);

/// An interface and the slab beneath it.
struct Layer {
    Spectrum ior = Spectrum::constant(1.5); ///< of the medium under the interface
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0; ///< ggx, beckmann: width; blinn: sqrt(2 / (exponent + 2)); 0 is smooth
    Scattering scattering = Scattering::Multiple;
    double thickness = 1.0;
    Spectrum absorption; ///< per unit of thickness; Beer-Lambert
};

/// Interfaces and slabs from the air down. Empty: a bare substrate in air.
struct LayerStack {
    std::vector<Layer> layers;

    bool is_smooth() const;     ///< every interface smooth
    bool is_dispersive() const; ///< some IOR depends on wavelength
    bool absorbs() const;
    /// True when nothing about the stack depends on wavelength.
    bool is_grey() const;
};

/// A layer at one wavelength.
struct LayerValues {
    double ior = 1.5;
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0;
    Scattering scattering = Scattering::Multiple;
    double tau = 0.0; ///< absorption * thickness: optical depth at normal passage

    bool operator==(const LayerValues&) const = default;
};
using StackValues = std::vector<LayerValues>;
StackValues stack_at(const LayerStack& stack, double wavelength_nm);

/// Width parameter from the half angle where D falls to D(0)/2 (INTERFACE): ggx alpha^2 =
/// sin^2 b / (sqrt 2 - cos^2 b); beckmann alpha = tan b / sqrt(ln 2 - 4 ln cos b); blinn
/// exponent = -ln 2 / ln cos b, alpha = sqrt(2 / (exponent + 2)). 0 for 0 degrees.
double alpha_from_roughness_deg(Distribution distribution, double roughness_deg);
/// Blinn exponent from alpha: 2 / alpha^2 - 2.
double blinn_exponent(double alpha);

} // namespace reradiant
