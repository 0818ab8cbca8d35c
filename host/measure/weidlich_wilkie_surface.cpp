#include "host/measure/surface_model.h"

#include "host/layers/models/weidlich_wilkie.h"
#include "host/layers/models/weidlich_wilkie_residual.h"
#include "host/layers/stack/quadrature.h"
#include "host/layers/stack/stack_check.h"
#include "host/measure/lobe_quadrature.h"
#include "host/measure/surface_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace reradiant {

using kernels::Vec3;

namespace {

/// Everything that model A needs at one band.
struct BandValues {
    StackValues stack;
    std::optional<ConductorValues> conductor;

    bool operator==(const BandValues&) const = default;
};

bool has_lobes(const StackValues& stack) {
    return std::any_of(stack.begin(), stack.end(), [](const LayerValues& l) {
        return l.alpha > 0.0 || l.tau_scattering > 0.0 || l.flake_coverage > 0.0;
    });
}

class WeidlichWilkieSurface final : public SurfaceModel {
public:
    WeidlichWilkieSurface(const LayerStack& stack, const SubstrateValues& substrate,
                          const WavelengthGrid& bands)
        : sigma_(substrate.sigma), matrix_(substrate.matrix) {
        std::vector<StackValues> stacks = values_at(stack, bands);
        for (std::size_t k = 0; k < stacks.size(); ++k) {
            BandValues& values = bands_.emplace_back();
            values.stack = std::move(stacks[k]);
            if (!substrate.conductor.empty())
                values.conductor = substrate.conductor[k];
            check_stack(values.stack);
            if (values.conductor)
                check_conductor(*values.conductor);
            const bool same = k > 0 && values == bands_[k - 1];
            residuals_.push_back(same ? residuals_.back()
                                      : WeidlichWilkieResidual(values.stack, values.conductor));
        }
        if (has_conductor())
            matrix_ = Eigen::MatrixXd::Identity(bands.count, bands.count);
    }

    const Eigen::MatrixXd& coupling() const override { return matrix_; }
    Eigen::MatrixXd diffuse(const Vec3& wi, const Vec3& wo) const override;
    double specular(int band, const Vec3& wi, const Vec3& wo) const override {
        return WeidlichWilkie::specular(at(band).stack, wi, wo) +
               (1.0 - conductor_share(band, wi.z)) * residual(band).value(wi.z, wo.z);
    }
    double specular_delta(int band, double c) const override {
        return WeidlichWilkie::specular_delta(at(band).stack, c);
    }
    double substrate_delta(int band, double c) const override {
        return has_conductor()
                   ? WeidlichWilkie::conductor_delta(at(band).stack, *at(band).conductor, c)
                   : 0.0;
    }
    Eigen::MatrixXd hemispherical_diffuse(double c) const override;
    double hemispherical_specular(int band, double c) const override;
    std::vector<AddingTransport::Lobe> lobes() const override;
    bool has_conductor() const override {
        return !bands_.empty() && bands_.front().conductor.has_value();
    }
    double lost(int, double) const override { return 0.0; }

private:
    const BandValues& at(int band) const { return bands_[static_cast<std::size_t>(band)]; }
    const WeidlichWilkieResidual& residual(int band) const {
        return residuals_[static_cast<std::size_t>(band)];
    }
    int bands() const { return static_cast<int>(bands_.size()); }

    /// The residual is one reciprocal product for all parts; what of it met the conductor is its
    /// share in the light from wi, which keeps the hemispherical values exact.
    double conductor_share(int band, double cos_i) const {
        const double whole = residual(band)(cos_i);
        return has_conductor() && whole > 0.0 ? residual(band).conductor_part(cos_i) / whole : 0.0;
    }
    double conductor_value(int band, const Vec3& wi, const Vec3& wo) const {
        return WeidlichWilkie::conductor(at(band).stack, *at(band).conductor, wi, wo) +
               conductor_share(band, wi.z) * residual(band).value(wi.z, wo.z);
    }
    /// The parts of the hemispherical values of one band, by quadrature.
    double hemispherical_conductor(int band, double c) const;
    Eigen::MatrixXd hemispherical_matrix(double c) const;

    double sigma_;
    Eigen::MatrixXd matrix_;
    std::vector<BandValues> bands_;
    std::vector<WeidlichWilkieResidual> residuals_;
};

Eigen::MatrixXd WeidlichWilkieSurface::diffuse(const Vec3& wi, const Vec3& wo) const {
    Eigen::VectorXd in(bands()), out(bands());
    for (int band = 0; band < bands(); ++band) {
        const StackValues& stack = at(band).stack;
        if (has_conductor()) {
            in(band) = 1.0;
            out(band) = conductor_value(band, wi, wo);
            continue;
        }
        in(band) = WeidlichWilkie::way_in(stack, wi, wo);
        out(band) = WeidlichWilkie::way_out(stack, wi, wo) * std::numbers::inv_pi *
                    WeidlichWilkie::diffuse_shape(stack, sigma_, wi, wo);
    }
    return out.asDiagonal() * matrix_ * in.asDiagonal();
}

/// A slope of the half vector in a medium is as many times as large in air as its IOR says.
std::vector<AddingTransport::Lobe> WeidlichWilkieSurface::lobes() const {
    const BandValues& middle = at(bands() / 2);
    std::vector<AddingTransport::Lobe> all;
    double ior = 1.0;
    const auto add = [&](const auto& part) {
        if (part.alpha > 0.0)
            all.push_back({part.distribution, std::min(1.0, ior * part.alpha)});
    };
    for (const LayerValues& layer : middle.stack) {
        add(layer);
        ior = layer.ior;
        if (layer.flake_coverage > 0.0)
            add(layer.flakes);
    }
    if (middle.conductor)
        add(*middle.conductor);
    return all;
}

/// Outgoing directions of one half of the hemisphere (the other half is its mirror image) with
/// their weights, cosine included, for both halves.
struct WeightedDirection {
    Vec3 direction;
    double weight;
};
std::vector<WeightedDirection> half_hemisphere(const std::vector<double>& breaks) {
    // Oren-Nayar's shape has a kink at 90 degrees of azimuth
    const Quadrature& azimuths = gauss_legendre(12);
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
                const double phi = 0.5 * std::numbers::pi * azimuths.nodes[k];
                for (const double azimuth : {phi, std::numbers::pi - phi}) {
                    directions.push_back({direction_at(c, azimuth),
                                          std::numbers::pi * azimuths.weights[k] * weight});
                }
            }
        }
    }
    return directions;
}

/// Pieces that suit all bands and the larger angle of Oren-Nayar's shape. A dispersive stack has
/// too many critical cosines to give each a piece of its own.
std::vector<double> breaks_of_all(const std::vector<BandValues>& bands, double cos_i) {
    std::vector<double> breaks;
    for (const BandValues& values : bands) {
        const std::vector<double> own = breaks_in_air(values.stack);
        breaks.insert(breaks.end(), own.begin(), own.end());
    }
    breaks = breaks_between_0_and_1(breaks);
    if (breaks.size() > 8)
        breaks = {0.25, 0.5, 0.75};
    breaks.push_back(cos_i);
    return breaks_between_0_and_1(breaks);
}

Eigen::MatrixXd WeidlichWilkieSurface::hemispherical_matrix(double c) const {
    const Vec3 wi = direction_at(c, 0.0);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(bands(), bands());
    // both ways depend on the half vector of rough interfaces, so they are integrated together
    for (const WeightedDirection& wo : half_hemisphere(breaks_of_all(bands_, c)))
        result += wo.weight * diffuse(wi, wo.direction);
    return result;
}

double WeidlichWilkieSurface::hemispherical_conductor(int band, double c) const {
    const BandValues& values = at(band);
    double sum = substrate_delta(band, c) + residual(band).conductor_part(c);
    if (values.conductor->alpha > 0.0) {
        const Vec3 wi = direction_at(c, 0.0);
        sum += integrate_about_mirror(wi, [&](const Vec3& wo) {
            return WeidlichWilkie::conductor(values.stack, *values.conductor, wi, wo);
        });
    }
    return sum;
}

Eigen::MatrixXd WeidlichWilkieSurface::hemispherical_diffuse(double c) const {
    if (!has_conductor())
        return hemispherical_matrix(c);
    Eigen::VectorXd diagonal(bands());
    for (int band = 0; band < bands(); ++band) {
        const bool same = band > 0 && at(band) == at(band - 1);
        diagonal(band) = same ? diagonal(band - 1) : hemispherical_conductor(band, c);
    }
    return diagonal.asDiagonal();
}

double WeidlichWilkieSurface::hemispherical_specular(int band, double c) const {
    const StackValues& stack = at(band).stack;
    double sum = specular_delta(band, c) + residual(band)(c) - residual(band).conductor_part(c);
    if (has_lobes(stack)) {
        const Vec3 wi = direction_at(c, 0.0);
        sum += integrate_about_mirror(
            wi, [&](const Vec3& wo) { return WeidlichWilkie::specular(stack, wi, wo); });
    }
    return sum;
}

} // namespace

std::unique_ptr<SurfaceModel> weidlich_wilkie_surface(const LayerStack& stack,
                                                      const SubstrateValues& substrate,
                                                      const WavelengthGrid& bands) {
    return std::make_unique<WeidlichWilkieSurface>(stack, substrate, bands);
}

} // namespace reradiant
