#include "host/measure/surface_angles.h"
#include "host/measure/surface_model.h"

#include "host/layers/models/effective_matrix.h"
#include "host/layers/models/oren_nayar_substrate.h"
#include "host/layers/rough/interface_walk.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/microfacet.h"
#include "kernels/scatter/oren_nayar.h"
#include "reradiant/adding.h"
#include "reradiant/error.h"

#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

class AddingSurface final : public SurfaceModel {
public:
    AddingSurface(const LayerStack& stack, const SubstrateValues& substrate,
                  const WavelengthGrid& bands)
        : stacks_(values_at(stack, bands)), sigma_(substrate.sigma), first_(substrate.matrix) {
        Eigen::VectorXd r(bands.count);
        for (int band = 0; band < bands.count; ++band) {
            const bool same = like_the_last(band);
            transports_.push_back(same ? transports_.back() : adding_transport(stack_at(band)));
            r(band) = same ? r(band - 1) : transports_.back()->internal_reflectance(sigma_);
        }
        rest_ = effective_matrix(kernels::oren_nayar_mean_albedo(sigma_) * first_, r);
    }

    const Eigen::MatrixXd& coupling() const override { return rest_; }

    /// Oren-Nayar's weights are those of the IOR at the emitted wavelength, like n_k.
    Eigen::MatrixXd diffuse(const Vec3& wi, const Vec3& wo) const override {
        return through_the_stack(wi.z, [&](int band) {
            const AddingTransport& t = transport(band);
            const double n = t.lowest_ior();
            const OrenNayarWeights weights = oren_nayar_weights(sigma_, n, wi, wo);
            const double out = t.transmission(wo.z) * std::numbers::inv_pi / (n * n);
            return OrenNayarWeights{out * weights.first, out * weights.rest};
        });
    }
    double specular(int band, const Vec3& wi, const Vec3& wo) const override {
        const AddingTransport& t = transport(band);
        double sum = t.has_top_lobe() ? top_lobe(band, wi, wo) : 0.0;
        const std::vector<AddingTransport::Lobe>& lobes = t.deeper_lobes();
        for (std::size_t l = 0; l < lobes.size(); ++l) {
            const int index = static_cast<int>(l);
            sum += t.lobe_amplitude(index, wi.z) * t.lobe_amplitude(index, wo.z) *
                   kernels::microfacet_reflection(kernel_distribution(lobes[l].distribution),
                                                  lobes[l].alpha, wi, wo);
        }
        if (t.residual_average() > 0.0) {
            sum +=
                t.residual(wi.z) * t.residual(wo.z) * std::numbers::inv_pi / t.residual_average();
        }
        return sum;
    }
    double specular_delta(int band, double c) const override {
        return transport(band).specular_delta(c);
    }
    double substrate_delta(int, double) const override { return 0.0; }
    Eigen::MatrixXd hemispherical_diffuse(double c) const override {
        OrenNayarWeights last{};
        return through_the_stack(c, [&](int band) {
            const AddingTransport& t = transport(band);
            if (!like_the_last(band))
                last = oren_nayar_hemispherical(sigma_, t.lowest_ior(), c,
                                                breaks_in_air(stack_at(band)),
                                                [&](double co) { return t.transmission(co); });
            return last;
        });
    }
    double hemispherical_specular(int band, double c) const override {
        return transport(band).specular_albedo(c);
    }
    std::vector<AddingTransport::Lobe> lobes() const override {
        const int middle = static_cast<int>(transports_.size()) / 2;
        std::vector<AddingTransport::Lobe> all = transport(middle).deeper_lobes();
        if (transport(middle).has_top_lobe())
            all.push_back({stack_at(middle).front().distribution, stack_at(middle).front().alpha});
        return all;
    }
    bool has_conductor() const override { return false; }
    double lost(int band, double c) const override { return transport(band).lost(c); }

private:
    const StackValues& stack_at(int band) const { return stacks_[static_cast<std::size_t>(band)]; }
    const AddingTransport& transport(int band) const {
        return *transports_[static_cast<std::size_t>(band)];
    }
    bool like_the_last(int band) const { return band > 0 && stack_at(band) == stack_at(band - 1); }

    /// {first M + rest B} T(ci) with the weights of each emitted band.
    template <typename Weights>
    Eigen::MatrixXd through_the_stack(double cos_i, const Weights& weights_of) const {
        Eigen::MatrixXd result(rest_.rows(), rest_.cols());
        for (Eigen::Index o = 0; o < result.rows(); ++o) {
            const OrenNayarWeights weights = weights_of(static_cast<int>(o));
            result.row(o) = weights.first * first_.row(o) + weights.rest * rest_.row(o);
        }
        for (Eigen::Index i = 0; i < result.cols(); ++i)
            result.col(i) *= transport(static_cast<int>(i)).transmission(cos_i);
        return result;
    }
    double top_lobe(int band, const Vec3& wi, const Vec3& wo) const {
        const LayerValues& layer = stack_at(band).front();
        const Vec3 h = kernels::vec3_normalise(kernels::vec3_add(wi, wo));
        return kernels::fresnel_dielectric(kernels::vec3_dot(wi, h), layer.ior) *
               kernels::microfacet_reflection(kernel_distribution(layer.distribution), layer.alpha,
                                              wi, wo);
    }

    std::vector<StackValues> stacks_;
    std::vector<std::shared_ptr<const AddingTransport>> transports_;
    double sigma_;
    Eigen::MatrixXd first_, rest_; ///< M and B of oren_nayar_substrate.h
};

} // namespace

std::unique_ptr<SurfaceModel> adding_surface(const LayerStack& stack,
                                             const SubstrateValues& substrate,
                                             const WavelengthGrid& bands) {
    if (!substrate.conductor.empty()) {
        throw_input_error({}, "adding does not know conductors",
                          "use the model walk or weidlich-wilkie");
    }
    return std::make_unique<AddingSurface>(stack, substrate, bands);
}

} // namespace reradiant
