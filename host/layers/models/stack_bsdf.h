#pragma once

#include "host/layers/models/oren_nayar_substrate.h"
#include "kernels/core/portable.h"
#include "reradiant/stack_elements.h"
#include "reradiant/stack_model.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

namespace reradiant {

/// A `StackBsdf` is the whole of a closed model at one wavelength: beside what depends on one
/// cosine (StackModel), its values between two directions, which are unit vectors in the local
/// frame (z = normal), both above the surface. Values are in 1/sr, without the cosine and without
/// deltas. LayeredBsdf puts wavelengths together (host/layers/models/layered_bsdf.h), and the
/// kernels' tables are made of the same functions.
class StackBsdf : public StackModel {
public:
    using StackModel::internal_reflectance;

    /// Light that never reached the substrate.
    virtual double specular(const kernels::Vec3& wi, const kernels::Vec3& wo) const = 0;

    /// Light that reached a conductor at the end of the stack: its value, the weight of its mirror
    /// delta and its share of the flux, delta included. All are 0 where there is none.
    virtual double conductor(const kernels::Vec3& /*wi*/, const kernels::Vec3& /*wo*/) const {
        return 0.0;
    }
    virtual double conductor_delta(double /*cos_theta*/) const { return 0.0; }
    virtual double conductor_albedo(double /*cos_theta*/) const { return 0.0; }

    /// Light that reached a diffuse substrate: f(lo, li) = {first(lo) M + rest(lo) B}(lo, li)
    /// way_in(li), where M and B are the operators of oren_nayar_substrate.h.
    virtual double way_in(const kernels::Vec3& wi, const kernels::Vec3& wo) const = 0;
    virtual OrenNayarWeights way_out(double sigma, const kernels::Vec3& wi,
                                     const kernels::Vec3& wo) const = 0;
    /// Returns the tables of an Oren-Nayar substrate of width sigma > 0 beneath the stack; nothing
    /// for a model that does not follow light back to it.
    virtual std::shared_ptr<const OrenNayarTables> oren_nayar_tables(double /*sigma*/) const {
        return nullptr;
    }
    /// Returns the integrals of way_out times the cosine over outgoing directions, for a model
    /// whose way in does not depend on these; nothing for one whose two ways do not come apart.
    virtual std::optional<OrenNayarWeights> whole_way_out(double /*sigma*/,
                                                          double /*cos_i*/) const {
        return std::nullopt;
    }

    /// Rough lobes over the half vector in air that cover the peaks of all that is reflected.
    virtual std::vector<LobeShape> lobes() const = 0;

    /// Returns approximately what each rough lobe reflects, the top one first (0 when there is
    /// none), then the others. This serves only for choosing among them: one whose shape is
    /// tabulated is sampled by the top lobe, which has its share too.
    virtual std::vector<double> lobe_shares(double cos_theta) const = 0;
    /// Returns approximately what slabs reflect by lobes of their own; the cosine lobe samples
    /// them.
    virtual double scattered_share(double /*cos_theta*/) const { return 0.0; }
    /// Factor of the substrate's operator: 1 / (pi n_k^2), or 1 / pi where n^2 is left out.
    virtual double diffuse_scale() const = 0;

    /// Weight of the mirror direction, of all parts.
    double delta(double cos_theta) const {
        return specular_delta(cos_theta) + conductor_delta(cos_theta);
    }
    /// Returns the residual over sqrt(pi * its average): the product of two is its value.
    double residual_amplitude(double cos_theta) const {
        const double average = residual_average();
        return average > 0.0 ? 1.0 / std::sqrt(std::numbers::pi * average) * residual(cos_theta)
                             : 0.0;
    }
};

/// Makes a closed model of a stack that may end in a substrate. Input Error for numbers out of
/// range and for what the model cannot do.
using ClosedModel = std::shared_ptr<const StackBsdf> (*)(const StackElements& stack);

} // namespace reradiant
