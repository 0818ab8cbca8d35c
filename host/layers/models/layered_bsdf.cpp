#include "host/layers/models/layered_bsdf.h"

#include "host/layers/models/effective_matrix.h"
#include "host/layers/rough/specular_lobes.h"
#include "host/layers/stack/directions.h"
#include "host/layers/stack/quadrature.h"
#include "host/layers/stack/slab_emission.h"
#include "host/layers/stack/stack_variants.h"
#include "kernels/scatter/oren_nayar.h"
#include "kernels/stack/layer_stack.h"
#include "reradiant/error.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

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

} // namespace

LayeredBsdf::LayeredBsdf(const LayerStack& stack, const SubstrateValues& substrate,
                         const WavelengthGrid& bands, ClosedModel model)
    : has_conductor_(!substrate.conductor.empty()), sigma_(substrate.sigma),
      first_(substrate.matrix), choices_(new_choices()) {
    for (int band = 0; band < bands.count; ++band) {
        stacks_.push_back(stack_at(stack, bands.centre_nm(band)));
        if (!stack.is_sheet())
            stacks_.back() = stack_over(std::move(stacks_.back()),
                                        substrate.at_band(static_cast<std::size_t>(band)));
    }
    make_models(model);
    if (is_sheet() || has_conductor_) {
        first_ = Eigen::MatrixXd::Zero(bands.count, bands.count);
        rest_ = has_conductor_ ? Eigen::MatrixXd::Identity(bands.count, bands.count) : first_;
    } else {
        Eigen::VectorXd r(bands.count);
        for (int band = 0; band < bands.count; ++band)
            r(band) = like_the_last(band) ? r(band - 1) : at(band).internal_reflectance(sigma_);
        rest_ = effective_matrix(kernels::oren_nayar_mean_albedo(sigma_) * first_, r);
    }
    coupling_ = rest_;
    if (stack.is_dyed())
        make_emitting(stack, bands);
    lobes_[0] = at(bands.count / 2).lobes();
    if (is_sheet())
        lobes_[1] = whole(bands.count / 2, Side::Below).lobes();
}

/// Models of neighbouring bands that do not differ are the same.
void LayeredBsdf::make_models(ClosedModel model) {
    const bool scattering = std::any_of(stacks_.begin(), stacks_.end(), [](const auto& elements) {
        return without_scattered(elements) != elements;
    });
    const StackElements& middle = stacks_[static_cast<std::size_t>(bands() / 2)];
    const bool is_sheet =
        std::holds_alternative<SurfaceValues>(middle.back()) && !conductor_of(middle);
    const auto lobe = is_sheet ? through_lobe(stacks_) : nullptr;
    for (int band = 0; band < bands(); ++band) {
        const StackElements& elements = stacks_[static_cast<std::size_t>(band)];
        const bool same = like_the_last(band);
        if (is_sheet) {
            sheets_.push_back(same ? sheets_.back()
                                   : std::make_shared<SheetTransmission>(elements, lobe));
            continue;
        }
        models_.push_back(same ? models_.back() : model(elements));
        unscattered_.push_back(same         ? unscattered_.back()
                               : scattering ? model(without_scattered(elements))
                                            : models_.back());
    }
}

void LayeredBsdf::make_emitting(const LayerStack& stack, const WavelengthGrid& bands) {
    if (has_conductor_ || sigma_ > 0.0)
        throw_input_error({}, "adding knows dyes in layers above a Lambertian substrate alone",
                          "use the model walk");
    DyedStack dyed{stacks_, slab_emissions(stack, bands), {}};
    for (const Eigen::MatrixXd& slab : dyed.slabs)
        if (slab.size() > 0)
            coupling_ += slab;
    if (!is_sheet())
        dyed.substrate = first_;
    emitting_ = std::make_shared<EmittingStack>(std::move(dyed));
    // what goes from one band to another may go on from there
    for (int via = 0; via < this->bands(); ++via)
        for (int i = 0; i < this->bands(); ++i)
            if (coupling_(via, i) != 0.0)
                coupling_.col(i) += coupling_.col(via).cwiseAbs();
}

const StackBsdf& LayeredBsdf::whole(int band, Side side) const {
    const auto k = static_cast<std::size_t>(band);
    return is_sheet() ? sheets_[k]->whole(side) : *models_[k];
}

const StackBsdf& LayeredBsdf::unscattered(int band, Side side) const {
    const auto k = static_cast<std::size_t>(band);
    return is_sheet() ? sheets_[k]->unscattered(side) : *unscattered_[k];
}

bool LayeredBsdf::like_the_last(int band) const {
    const auto k = static_cast<std::size_t>(band);
    return k > 0 && stacks_[k] == stacks_[k - 1];
}

namespace {

/// What dyes and substrate send out, without what never reached the substrate.
template <typename Light>
Eigen::MatrixXd reached_substrate(const Light& light) {
    return (light(EmittingStack::Part::All) - light(EmittingStack::Part::Slab)).cwiseMax(0.0);
}

} // namespace

Eigen::MatrixXd LayeredBsdf::eval(const Vec3& wi, const Vec3& wo) const {
    const auto is_seen = [&](const Vec3& w) { return is_sheet() ? w.z != 0.0 : w.z > 0.0; };
    if (!is_seen(wi) || !is_seen(wo))
        return Eigen::MatrixXd::Zero(bands(), bands());
    const Parts f = parts(wi, wo);
    return f.diffuse + f.slab + Eigen::MatrixXd(f.specular.asDiagonal());
}

LayeredBsdf::Parts LayeredBsdf::parts(const Vec3& wi, const Vec3& wo) const {
    const Side from = side_of(wi), to = side_of(wo);
    const Vec3 in = mirrored_above(wi), out = mirrored_above(wo);
    const Vec3& above = from == Side::Above ? in : out;
    const Vec3& below = from == Side::Above ? out : in;
    Parts f{Eigen::MatrixXd::Zero(bands(), bands()), Eigen::MatrixXd::Zero(bands(), bands()),
            Eigen::VectorXd::Zero(bands())};
    for (int band = 0; band < bands(); ++band) {
        if (from == to) {
            f.specular(band) = unscattered(band, from).specular(in, out);
            f.slab(band, band) = whole(band, from).specular(in, out) - f.specular(band);
        } else {
            const SheetTransmission& sheet = *sheets_[static_cast<std::size_t>(band)];
            f.specular(band) = sheet.specular(above, below);
            f.slab(band, band) = sheet.scattered(above.z, below.z);
        }
    }
    f.slab = f.slab.cwiseMax(0.0);
    if (emitting_)
        f.slab += emitting_->value(air_direction(wi), air_direction(wo), EmittingStack::Part::Slab);
    if (!is_sheet())
        f.diffuse = diffuse(wi, wo);
    return f;
}

LayeredBsdf::Parts LayeredBsdf::albedo(const AirDirection& from, Side to) const {
    const double c = from.cosine;
    Parts sum{Eigen::MatrixXd::Zero(bands(), bands()), Eigen::MatrixXd::Zero(bands(), bands()),
              Eigen::VectorXd::Zero(bands())};
    for (int band = 0; band < bands(); ++band) {
        if (from.side == to) {
            sum.specular(band) = unscattered(band, to).specular_albedo(c);
            sum.slab(band, band) = whole(band, to).specular_albedo(c) - sum.specular(band);
        } else {
            const SheetTransmission& sheet = *sheets_[static_cast<std::size_t>(band)];
            sum.specular(band) = sheet.specular_albedo(c, from.side);
            sum.slab(band, band) = sheet.scattered_albedo(c, from.side);
        }
    }
    sum.slab = sum.slab.cwiseMax(0.0);
    if (emitting_)
        sum.slab += emitting_->albedo(from, to, EmittingStack::Part::Slab);
    if (!is_sheet())
        sum.diffuse = diffuse_albedo(c);
    return sum;
}

Eigen::MatrixXd LayeredBsdf::diffusely_lit(const AirDirection& to) const {
    Eigen::MatrixXd seen = emitting_->diffusely_lit(to.side, to, EmittingStack::Part::All);
    for (int band = 0; band < bands(); ++band)
        seen(band, band) += whole(band, to.side).specular_albedo(to.cosine);
    return seen;
}

Eigen::MatrixXd LayeredBsdf::guided(const AirDirection& from) const {
    return emitting_ && is_sheet() ? emitting_->guided(from)
                                   : Eigen::MatrixXd::Zero(bands(), bands());
}

/// {first M + rest B} way_in with the weights of each emitted band.
template <typename WayOut, typename WayIn>
Eigen::MatrixXd LayeredBsdf::between(const WayOut& way_out, const WayIn& way_in) const {
    Eigen::MatrixXd result(bands(), bands());
    for (int o = 0; o < bands(); ++o) {
        const OrenNayarWeights weights = way_out(o);
        result.row(o) = weights.first * first_.row(o) + weights.rest * rest_.row(o);
    }
    for (int i = 0; i < bands(); ++i)
        result.col(i) *= way_in(i);
    return result;
}

Eigen::MatrixXd LayeredBsdf::diffuse(const Vec3& wi, const Vec3& wo) const {
    if (emitting_)
        return reached_substrate([&](EmittingStack::Part part) {
            return emitting_->value(air_direction(wi), air_direction(wo), part);
        });
    if (has_conductor_) {
        Eigen::VectorXd diagonal(bands());
        for (int band = 0; band < bands(); ++band)
            diagonal(band) = at(band).conductor(wi, wo);
        return diagonal.asDiagonal();
    }
    return between([&](int band) { return at(band).way_out(sigma_, wi, wo); },
                   [&](int band) { return at(band).way_in(wi, wo); });
}

Eigen::MatrixXd LayeredBsdf::diffuse_albedo(double c) const {
    if (emitting_)
        return reached_substrate([&](EmittingStack::Part part) {
            return emitting_->albedo({c, Side::Above}, Side::Above, part);
        });
    if (has_conductor_)
        return conductor_albedo(c);
    const Vec3 wi = direction_at(c, 0.0);
    std::vector<OrenNayarWeights> whole;
    for (int band = 0; band < bands(); ++band) {
        if (like_the_last(band)) {
            whole.push_back(whole.back());
            continue;
        }
        const std::optional<OrenNayarWeights> own = at(band).whole_way_out(sigma_, c);
        if (!own)
            return joint_albedo(c);
        whole.push_back(*own);
    }
    return between([&](int band) { return whole[static_cast<std::size_t>(band)]; },
                   [&](int band) { return at(band).way_in(wi, wi); });
}

Eigen::MatrixXd LayeredBsdf::conductor_albedo(double c) const {
    Eigen::VectorXd diagonal(bands());
    for (int band = 0; band < bands(); ++band)
        diagonal(band) = like_the_last(band) ? diagonal(band - 1) : at(band).conductor_albedo(c);
    return diagonal.asDiagonal();
}

/// Both ways depend on the half vector of rough interfaces, so they are integrated together.
Eigen::MatrixXd LayeredBsdf::joint_albedo(double c) const {
    const Vec3 wi = direction_at(c, 0.0);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(bands(), bands());
    for (const WeightedDirection& wo : half_hemisphere(breaks_of_all(c)))
        result += wo.weight * diffuse(wi, wo.direction);
    return result;
}

/// Pieces that suit all bands and the larger angle of Oren-Nayar's shape. A dispersive stack has
/// too many critical cosines to give each a piece of its own.
std::vector<double> LayeredBsdf::breaks_of_all(double cos_i) const {
    std::vector<double> breaks;
    for (const StackElements& stack : stacks_) {
        const std::vector<double> own = breaks_in_air(stack);
        breaks.insert(breaks.end(), own.begin(), own.end());
    }
    breaks = breaks_between_0_and_1(breaks);
    if (breaks.size() > 8)
        breaks = {0.25, 0.5, 0.75};
    breaks.push_back(cos_i);
    return breaks_between_0_and_1(breaks);
}

Eigen::VectorXd LayeredBsdf::delta(double cos_theta, Side from) const {
    Eigen::VectorXd weight(bands());
    for (int band = 0; band < bands(); ++band)
        weight(band) = whole(band, from).delta(cos_theta);
    return weight;
}

Eigen::VectorXd LayeredBsdf::straight_on(double cos_theta) const {
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(bands());
    for (int band = 0; is_sheet() && band < bands(); ++band)
        weight(band) = sheets_[static_cast<std::size_t>(band)]->delta(cos_theta);
    return weight;
}

} // namespace reradiant
