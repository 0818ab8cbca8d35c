#include "host/measure/surface_angles.h"
#include "host/measure/surface_model.h"

#include "host/layers/adding.h"
#include "host/layers/effective_matrix.h"
#include "host/layers/interface_walk.h"
#include "host/layers/quadrature.h"
#include "kernels/fresnel.h"
#include "kernels/microfacet.h"

#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

class AddingSurface final : public SurfaceModel {
public:
    AddingSurface(const LayerStack& stack, const Eigen::MatrixXd& per_band,
                  const WavelengthGrid& bands)
        : stacks_(values_at(stack, bands)) {
        Eigen::VectorXd r(bands.count);
        for (int band = 0; band < bands.count; ++band) {
            const auto k = static_cast<std::size_t>(band);
            const bool same = band > 0 && stacks_[k] == stacks_[k - 1];
            transports_.push_back(same ? transports_.back() : adding_transport(stacks_[k]));
            r(band) = transports_.back()->internal_reflectance();
            escape_.push_back(same ? escape_.back() : escape_of(stacks_[k], *transports_.back()));
        }
        centre_ = effective_matrix(per_band, r);
    }

    const Eigen::MatrixXd& centre() const override { return centre_; }
    double way_in(int band, const Vec3& wi, const Vec3&) const override {
        return transport(band).transmission(wi.z);
    }
    double way_out(int band, const Vec3&, const Vec3& wo) const override {
        const double n = transport(band).lowest_ior();
        return transport(band).transmission(wo.z) * std::numbers::inv_pi / (n * n);
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
    Eigen::MatrixXd hemispherical_diffuse(double c) const override {
        Eigen::MatrixXd result = centre_;
        for (Eigen::Index band = 0; band < result.rows(); ++band) {
            result.row(band) *= escape_[static_cast<std::size_t>(band)];
        }
        for (Eigen::Index band = 0; band < result.cols(); ++band) {
            result.col(band) *= transport(static_cast<int>(band)).transmission(c);
        }
        return result;
    }
    double hemispherical_specular(int band, double c) const override {
        return transport(band).specular_albedo(c);
    }
    double lost(int band, double c) const override { return transport(band).lost(c); }

private:
    const AddingTransport& transport(int band) const {
        return *transports_[static_cast<std::size_t>(band)];
    }
    /// Share of a diffuse exitance under the stack that leaves into the air in one go.
    static double escape_of(const StackValues& stack, const AddingTransport& transport) {
        const double n = transport.lowest_ior();
        return integrate_pieces(breaks_in_air(stack), 64,
                                [&](double c) { return 2.0 * c * transport.transmission(c); }) /
               (n * n);
    }
    double top_lobe(int band, const Vec3& wi, const Vec3& wo) const {
        const LayerValues& layer = stacks_[static_cast<std::size_t>(band)].front();
        const Vec3 h = kernels::vec3_normalise(kernels::vec3_add(wi, wo));
        return kernels::fresnel_dielectric(kernels::vec3_dot(wi, h), layer.ior) *
               kernels::microfacet_reflection(kernel_distribution(layer.distribution), layer.alpha,
                                              wi, wo);
    }

    std::vector<StackValues> stacks_;
    std::vector<std::shared_ptr<const AddingTransport>> transports_;
    std::vector<double> escape_;
    Eigen::MatrixXd centre_;
};

} // namespace

std::unique_ptr<SurfaceModel> adding_surface(const LayerStack& stack,
                                             const Eigen::MatrixXd& per_band,
                                             const WavelengthGrid& bands) {
    return std::make_unique<AddingSurface>(stack, per_band, bands);
}

} // namespace reradiant
