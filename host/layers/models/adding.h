#pragma once

#include "host/layers/angular/substrate_arrivals.h"
#include "host/layers/models/stack_bsdf.h"

#include <map>
#include <mutex>
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
    std::shared_ptr<const OrenNayarTables> oren_nayar_tables(double sigma) const override;
    double internal_reflectance(double sigma) const override;
    std::vector<LobeShape> lobes() const override;
    double lowest_ior() const override { return lowest_ior_; }
    double diffuse_scale() const override;

protected:
    explicit AddingModel(std::span<const StackElement> stack);

    /// Internal reflectance for diffuse light.
    virtual double diffuse_reflectance() const = 0;
    /// What comes back of diffuse emission, as separable_oren_nayar takes it.
    virtual Eigen::MatrixXd returned_to_substrate(const CosineNodes& nodes) const = 0;
    /// Where light arrives at the substrate if it is spread on its way; else null.
    virtual std::shared_ptr<const SubstrateArrivals> arrivals() const { return nullptr; }

private:
    double top_lobe(const kernels::Vec3& wi, const kernels::Vec3& wo) const;
    /// The model of the stack without absorption, which may be this one.
    const AddingModel& clear() const;
    const Eigen::MatrixXd& returned() const;
    SeparableOrenNayar separable(double sigma) const;
    std::shared_ptr<const OrenNayarTables> make_tables(double sigma) const;

    SurfaceValues top_; ///< the first interface, if there is one
    double lowest_ior_;
    std::vector<double> breaks_in_air_;     ///< pieces of a quadrature over the cosine
    std::vector<StackElement> clear_stack_; ///< empty for a stack without absorption
    mutable std::once_flag clear_made_, returned_made_;
    mutable std::shared_ptr<const AddingModel> clear_;
    mutable Eigen::MatrixXd returned_;
    mutable std::mutex tables_mutex_;
    mutable std::map<double, std::shared_ptr<const OrenNayarTables>> tables_; ///< by sigma
};

/// Model B, every interreflection, as adding_transport makes it. It knows no conductors.
std::shared_ptr<const StackBsdf> adding_bsdf(const StackElements& stack);

} // namespace reradiant
