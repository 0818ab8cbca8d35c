#include "host/layers/quadrature.h"
#include "host/layers/weidlich_wilkie.h"
#include "host/measure/surface_angles.h"
#include "host/measure/surface_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

class WeidlichWilkieSurface final : public SurfaceModel {
public:
    WeidlichWilkieSurface(const LayerStack& stack, const Eigen::MatrixXd& per_band,
                          const WavelengthGrid& bands)
        : stacks_(values_at(stack, bands)), centre_(per_band) {}

    const Eigen::MatrixXd& centre() const override { return centre_; }
    double way_in(int band, const Vec3& wi, const Vec3& wo) const override {
        return WeidlichWilkie::way_in(at(band), wi, wo);
    }
    double way_out(int band, const Vec3& wi, const Vec3& wo) const override {
        return WeidlichWilkie::way_out(at(band), wi, wo) * std::numbers::inv_pi;
    }
    double specular(int band, const Vec3& wi, const Vec3& wo) const override {
        return WeidlichWilkie::specular(at(band), wi, wo);
    }
    double specular_delta(int band, double c) const override {
        return WeidlichWilkie::specular_delta(at(band), c);
    }
    Eigen::MatrixXd hemispherical_diffuse(double c) const override;
    double hemispherical_specular(int band, double c) const override;
    double lost(int, double) const override { return 0.0; }

private:
    const StackValues& at(int band) const { return stacks_[static_cast<std::size_t>(band)]; }

    std::vector<StackValues> stacks_;
    Eigen::MatrixXd centre_;
};

/// Outgoing directions of one half of the hemisphere (the other half is its mirror image) with
/// their weights, cosine included, for both halves.
struct WeightedDirection {
    Vec3 direction;
    double weight;
};
std::vector<WeightedDirection> half_hemisphere(const std::vector<double>& breaks) {
    const Quadrature& azimuths = gauss_legendre(24);
    const Quadrature& rule = gauss_legendre(32);
    std::vector<WeightedDirection> directions;
    for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
        const double width = breaks[piece + 1] - breaks[piece];
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double u = 0.5 * std::numbers::pi * rule.nodes[i];
            const double s = std::sin(u);
            const double c = breaks[piece] + width * s * s;
            const double weight = rule.weights[i] * std::numbers::pi * s * std::cos(u) * width * c;
            for (std::size_t k = 0; k < azimuths.nodes.size(); ++k) {
                directions.push_back({direction_at(c, std::numbers::pi * azimuths.nodes[k]),
                                      2.0 * std::numbers::pi * azimuths.weights[k] * weight});
            }
        }
    }
    return directions;
}

/// Pieces that suit all bands. A dispersive stack has too many critical cosines to give each a
/// piece of its own.
std::vector<double> breaks_of_all(const std::vector<StackValues>& stacks) {
    std::vector<double> breaks;
    for (const StackValues& stack : stacks) {
        const std::vector<double> own = breaks_in_air(stack);
        breaks.insert(breaks.end(), own.begin(), own.end());
    }
    breaks = breaks_between_0_and_1(breaks);
    return breaks.size() > 8 ? std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0} : breaks;
}

Eigen::MatrixXd WeidlichWilkieSurface::hemispherical_diffuse(double c) const {
    const Vec3 wi = direction_at(c, 0.0);
    const Eigen::Index n = centre_.rows();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd in(n), out(n);
    // both ways depend on the half vector of rough interfaces, so they are integrated together
    for (const WeightedDirection& wo : half_hemisphere(breaks_of_all(stacks_))) {
        for (Eigen::Index band = 0; band < n; ++band) {
            in(band) = way_in(static_cast<int>(band), wi, wo.direction);
            out(band) = way_out(static_cast<int>(band), wi, wo.direction);
        }
        result += wo.weight * out * in.transpose();
    }
    return result.cwiseProduct(centre_);
}

/// Lobes by quadrature over the half vector in air, on pieces that shrink towards the normal, so
/// that a lobe of any width is resolved.
double WeidlichWilkieSurface::hemispherical_specular(int band, double c) const {
    const StackValues& stack = at(band);
    double sum = WeidlichWilkie::specular_delta(stack, c);
    if (std::all_of(stack.begin(), stack.end(), [](const auto& l) { return l.alpha == 0.0; })) {
        return sum;
    }
    const Vec3 wi = direction_at(c, 0.0);
    const Quadrature& azimuths = gauss_legendre(32);
    const Quadrature& rule = gauss_legendre(12);
    for (double high = 0.5 * std::numbers::pi; high > 1e-6; high *= 0.5) {
        for (std::size_t k = 0; k < azimuths.nodes.size() * rule.nodes.size(); ++k) {
            const std::size_t i = k % rule.nodes.size(), j = k / rule.nodes.size();
            const double theta = 0.5 * high * (1.0 + rule.nodes[i]);
            const Vec3 h = direction_at(std::cos(theta), std::numbers::pi * azimuths.nodes[j]);
            const double cos_h = kernels::vec3_dot(wi, h);
            const Vec3 wo = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * cos_h), wi);
            if (cos_h > 0.0 && wo.z > 0.0) {
                sum += 0.5 * high * rule.weights[i] * 2.0 * std::numbers::pi * azimuths.weights[j] *
                       std::sin(theta) * 4.0 * cos_h * wo.z * specular(band, wi, wo);
            }
        }
    }
    return sum;
}

} // namespace

std::unique_ptr<SurfaceModel> weidlich_wilkie_surface(const LayerStack& stack,
                                                      const Eigen::MatrixXd& per_band,
                                                      const WavelengthGrid& bands) {
    return std::make_unique<WeidlichWilkieSurface>(stack, per_band, bands);
}

} // namespace reradiant
