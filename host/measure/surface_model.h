#pragma once

#include "host/layers/stack/substrate_values.h"
#include "kernels/core/portable.h"
#include "reradiant/adding.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace reradiant {

/// A `SurfaceModel` gives what a closed model says of a stack over a substrate, at the band
/// centres. Directional values are without the cosine. `diffuse` is light that reached the
/// substrate, of whatever type; `specular` is light that never did.
class SurfaceModel {
public:
    virtual ~SurfaceModel() = default;

    /// (bands, bands), rows = emission: zero where no light can go from one band to another.
    virtual const Eigen::MatrixXd& coupling() const = 0;
    /// Returns the diffuse part without deltas, per band: (bands, bands), rows = emission, 1/sr.
    virtual Eigen::MatrixXd diffuse(const kernels::Vec3& wi, const kernels::Vec3& wo) const = 0;
    /// Returns the specular part without deltas, 1/sr.
    virtual double specular(int band, const kernels::Vec3& wi, const kernels::Vec3& wo) const = 0;
    /// Weights of the mirror deltas, unit 1: of the stack, and of a smooth conductor under it.
    virtual double specular_delta(int band, double cos_theta) const = 0;
    virtual double substrate_delta(int band, double cos_theta) const = 0;
    /// Directional-hemispherical, deltas included: (bands, bands), rows = emission, unit 1.
    virtual Eigen::MatrixXd hemispherical_diffuse(double cos_theta) const = 0;
    /// Share of the flux that leaves without having reached the substrate, delta included.
    virtual double hemispherical_specular(int band, double cos_theta) const = 0;
    /// Rough lobes over the half vector in air that cover the peaks of the two parts.
    virtual std::vector<AddingTransport::Lobe> lobes() const = 0;
    /// True when `diffuse` is the reflection of a conductor.
    virtual bool has_conductor() const = 0;
    /// Share of the flux that single scattering loses on the way in.
    virtual double lost(int band, double cos_theta) const = 0;
};

/// Model B, every interreflection. Input Error for a conductor and for stacks that adding refuses.
std::unique_ptr<SurfaceModel> adding_surface(const LayerStack& stack,
                                             const SubstrateValues& substrate,
                                             const WavelengthGrid& bands);
/// Model A, Weidlich and Wilkie 2007, for anything. Hemispherical values are integrated
/// numerically, to about 1e-5 of the incident light (1e-4 with blinn, whose G has kinks).
std::unique_ptr<SurfaceModel> weidlich_wilkie_surface(const LayerStack& stack,
                                                      const SubstrateValues& substrate,
                                                      const WavelengthGrid& bands);

} // namespace reradiant
