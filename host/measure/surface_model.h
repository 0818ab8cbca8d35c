#pragma once

#include "host/layers/stack.h"
#include "host/spectral/grid.h"
#include "kernels/portable.h"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace reradiant {

/// What a model says about a stack over a substrate, per band: f_diffuse(lo, li) =
/// way_out(lo) centre(lo, li) way_in(li). All per band, at the band centres. No cosine.
class SurfaceModel {
public:
    virtual ~SurfaceModel() = default;

    /// The re-radiation matrix as it acts under the stack: (bands, bands), rows = emission, unit 1.
    virtual const Eigen::MatrixXd& centre() const = 0;
    /// Unit 1.
    virtual double way_in(int band, const kernels::Vec3& wi, const kernels::Vec3& wo) const = 0;
    /// 1/sr.
    virtual double way_out(int band, const kernels::Vec3& wi, const kernels::Vec3& wo) const = 0;
    /// Light that never reached the substrate, without deltas, 1/sr.
    virtual double specular(int band, const kernels::Vec3& wi, const kernels::Vec3& wo) const = 0;
    /// Weight of the mirror delta, unit 1.
    virtual double specular_delta(int band, double cos_theta) const = 0;
    /// Hemispherical diffuse reflectances for light from wi: (bands, bands), unit 1.
    virtual Eigen::MatrixXd hemispherical_diffuse(double cos_theta) const = 0;
    /// Share of the flux that leaves without having reached the substrate, delta included.
    virtual double hemispherical_specular(int band, double cos_theta) const = 0;
    /// Share of the flux that single scattering loses on the way in.
    virtual double lost(int band, double cos_theta) const = 0;
};

/// Model B, every interreflection.
std::unique_ptr<SurfaceModel> adding_surface(const LayerStack& stack,
                                             const Eigen::MatrixXd& per_band,
                                             const WavelengthGrid& bands);
/// Model A, Weidlich and Wilkie 2007.
std::unique_ptr<SurfaceModel> weidlich_wilkie_surface(const LayerStack& stack,
                                                      const Eigen::MatrixXd& per_band,
                                                      const WavelengthGrid& bands);

} // namespace reradiant
