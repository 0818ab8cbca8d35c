#pragma once

#include "host/layers/adding.h"
#include "host/scene/scene.h"

#include <memory>
#include <vector>

namespace reradiant {

/// A stack at one wavelength as the kernels' tables see it, for either closed model.
class StackOptics {
public:
    virtual ~StackOptics() = default;
    virtual double transmission(double cos_theta) const = 0; ///< one way to the substrate
    virtual double delta(double cos_theta) const = 0;        ///< weight of the mirror direction
    virtual double residual(double cos_theta) const = 0;     ///< over sqrt(pi * its average)
    virtual double amplitude(int lobe, double cos_theta) const = 0;
    /// Share of the directional reflectance that the rough lobes carry (for choosing among them).
    virtual double rough_share(double cos_theta) const = 0;
    /// r of the substrate's interreflection; 0 for a model without.
    virtual double internal_reflectance() const = 0;
    /// Factor of the substrate's operator: 1 / (pi n_k^2), or 1 / pi.
    virtual double diffuse_scale() const = 0;
    virtual const std::vector<AddingTransport::Lobe>& deeper_lobes() const = 0;
};

std::unique_ptr<StackOptics> stack_optics(const LayerStack& stack, Model model,
                                          double wavelength_nm);

/// Indices of the interfaces that make deeper rough lobes: all below the first rough interface,
/// and that one too unless it is the top.
std::vector<int> deeper_lobe_layers(const LayerStack& stack);

} // namespace reradiant
