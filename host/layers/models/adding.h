#pragma once

#include "host/layers/models/stack_bsdf.h"

#include <optional>
#include <span>
#include <vector>

namespace reradiant {

/// Model B between two directions, from what it says of one. Its two forms are SmoothTransport
/// (host/layers/smooth/smooth_transport.cpp) and AngularTransport
/// (host/layers/angular/angular_transport.cpp).
class AddingModel : public StackBsdf {
public:
    double specular(const kernels::Vec3& wi, const kernels::Vec3& wo) const override;
    double way_in(const kernels::Vec3& wi, const kernels::Vec3& wo) const override;
    /// Oren-Nayar's weights are those of the IOR at the emitted wavelength, like n_k.
    OrenNayarWeights way_out(double sigma, const kernels::Vec3& wi,
                             const kernels::Vec3& wo) const override;
    std::optional<OrenNayarWeights> whole_way_out(double sigma, double cos_i) const override;
    std::vector<LobeShape> lobes() const override;
    double lowest_ior() const override { return lowest_ior_; }
    double diffuse_scale() const override;

protected:
    explicit AddingModel(std::span<const StackElement> stack);

private:
    double top_lobe(const kernels::Vec3& wi, const kernels::Vec3& wo) const;

    SurfaceValues top_; ///< the first interface, if there is one
    double lowest_ior_;
    std::vector<double> breaks_in_air_; ///< pieces of a quadrature over the cosine
};

/// Model B, every interreflection, as adding_transport makes it. It knows no conductors.
std::shared_ptr<const StackBsdf> adding_bsdf(const StackElements& stack);

} // namespace reradiant
