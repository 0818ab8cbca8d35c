#pragma once

#include "reradiant/stack_model.h"

#include <optional>
#include <vector>

/// Stacks at one wavelength as tests write them: layer by layer.
namespace reradiant {

/// An interface, the slab beneath it and the flakes at its lower end.
struct LayerValues {
    double ior = 1.5;
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0;
    Scattering scattering = Scattering::Multiple;
    double tau = 0.0, tau_scattering = 0.0, anisotropy = 0.0;
    FilmValues film = {};
    double flake_coverage = 0.0; ///< 0: no flakes
    SurfaceValues flakes = {};
    double wavelength_nm = 0.0;
};
using StackValues = std::vector<LayerValues>;

inline SurfaceValues conductor_values(double ior, double kappa, Distribution distribution,
                                      double alpha, Scattering scattering = Scattering::Multiple) {
    return {1.0, ior, kappa, true, distribution, alpha, scattering};
}

/// The layers, and a conductor beneath them if one is given.
inline StackElements stack_of(const StackValues& layers,
                              const std::optional<SurfaceValues>& conductor = {}) {
    StackElements stack;
    double ior = 1.0;
    for (const LayerValues& l : layers) {
        stack.push_back(SurfaceValues{ior, l.ior, 0.0, false, l.distribution, l.alpha, l.scattering,
                                      l.film, l.wavelength_nm});
        stack.push_back(
            SlabValues{l.ior, l.tau, l.tau_scattering, l.anisotropy, l.tau_scattering > 0.0});
        ior = l.ior;
        if (l.flake_coverage > 0.0) {
            FlakesValues flakes{l.flake_coverage, l.flakes};
            flakes.reflector.ior_above = ior;
            stack.push_back(flakes);
        }
    }
    return conductor ? stack_over(std::move(stack), *conductor) : stack;
}

inline std::shared_ptr<const StackModel> adding_transport(const StackValues& layers) {
    return adding_transport(stack_of(layers));
}

} // namespace reradiant
