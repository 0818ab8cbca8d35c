#include "host/layers/walk/walk.h"

#include "host/layers/walk/walk_connector.h"
#include "kernels/scatter/henyey_greenstein.h"
#include "kernels/scatter/oren_nayar.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace reradiant {

using kernels::Vec3;
using Kind = WalkElement::Kind;

namespace {

/// `WalkThroughput` holds the weights that one walk carries: those of all bands, or that of the
/// band that the walk is in.
class WalkThroughput {
public:
    WalkThroughput(const WalkMaterial& material, std::optional<int> band)
        : material_(material), start_(band), band_(band.value_or(0)),
          rows_(Eigen::ArrayXd::Ones(band ? 1 : material.bands())) {}

    const WalkElements& elements() const {
        return start_ ? material_.at_band(band_) : material_.shared();
    }
    int band() const { return band_; }
    bool reached() const { return reached_; }
    const Eigen::ArrayXd& rows() const { return rows_; }
    double largest() const { return rows_.maxCoeff() * largest_full_; }

    void reach() { reached_ = true; }
    void scale(double factor) { rows_ *= factor; }
    void absorb(const Eigen::ArrayXd& depth) { rows_ *= (-depth).exp(); }
    void re_radiate(WalkRandom& random) {
        if (start_) {
            draw_band(random.next());
        } else if (material_.is_fluorescent()) {
            const Eigen::MatrixXd sent = full_.size() > 0
                                             ? Eigen::MatrixXd(rows_.matrix().asDiagonal() * full_)
                                             : Eigen::MatrixXd(rows_.matrix().asDiagonal());
            full_.noalias() = material_.matrix() * sent;
            rows_.setOnes();
            largest_full_ = full_.maxCoeff();
        } else {
            rows_ *= material_.matrix().diagonal().array();
        }
    }

    /// Adds `factor` times what is carried to the part of the tally that it belongs to.
    void add_to(WalkTally::Parts& parts, const Eigen::ArrayXd& factor) const {
        if (!reached_) {
            add_rows(parts.specular, factor);
        } else if (!material_.is_fluorescent()) {
            auto diagonal = parts.diffuse.col(0);
            add_rows(diagonal, factor);
        } else if (start_) {
            parts.diffuse(band_, *start_) += rows_(0) * factor(0);
        } else {
            parts.diffuse.noalias() += (rows_ * factor).matrix().asDiagonal() * full_;
        }
    }
    void add_to(Eigen::VectorXd& sums, double factor) const {
        add_rows(sums, Eigen::ArrayXd::Constant(rows_.size(), factor));
    }

private:
    template <typename Vector>
    void add_rows(Vector& sums, const Eigen::ArrayXd& factor) const {
        if (start_)
            sums(band_) += rows_(0) * factor(0);
        else
            sums.array() += rows_ * factor;
    }

    void draw_band(double u) {
        const auto column = material_.matrix().col(band_);
        const double total = column.sum();
        rows_ *= total;
        double rest = u * total;
        for (int to = 0; to < material_.bands() && total > 0.0; ++to) {
            if (column(to) > 0.0) {
                band_ = to; // the last possible one where rounding leaves a rest
                rest -= column(to);
                if (rest < 0.0)
                    break;
            }
        }
    }

    const WalkMaterial& material_;
    std::optional<int> start_;
    int band_;
    Eigen::ArrayXd rows_;
    Eigen::MatrixXd full_; ///< (emission, excitation) once something has been re-radiated
    double largest_full_ = 1.0;
    bool reached_ = false;
};

/// The paths that come down from the directions asked for, made when they are first needed.
class Connectors {
public:
    Connectors(std::span<const Vec3> wo, std::uint64_t seed, std::uint64_t sample)
        : wo_(wo), seed_(seed), sample_(sample) {}

    std::size_t size() const { return wo_.size(); }
    const std::vector<WalkConnector>& of(const WalkThroughput& carried) {
        if (made_.empty() || band_ != carried.band()) {
            made_.clear();
            band_ = carried.band();
            for (std::size_t k = 0; k < wo_.size(); ++k) {
                WalkRandom random(seed_, sample_, k + 1); // the same at all bands
                made_.push_back(
                    connect_down(carried.elements(), wo_[k], carried.rows().size(), random));
            }
        }
        return made_;
    }

private:
    std::span<const Vec3> wo_;
    std::uint64_t seed_, sample_;
    int band_ = 0;
    std::vector<WalkConnector> made_;
};

/// One walk from the air until it ends or leaves.
class Walk {
public:
    Walk(WalkThroughput carried, const Vec3& wi, WalkRandom& random, Connectors* connectors,
         WalkTally* tally)
        : carried_(std::move(carried)), random_(random), connectors_(connectors), tally_(tally),
          d_(kernels::vec3(-wi.x, -wi.y, -wi.z)) {}

    void run() {
        while (going_ && at_ >= 0)
            advance();
    }
    /// Goes on until the light meets a diffuse substrate; false where it does not.
    bool run_to_substrate() {
        while (going_ && at_ >= 0 && element().kind != Kind::Diffuse)
            advance();
        return going_ && at_ >= 0;
    }
    bool has_left() const { return going_; }
    bool is_delta() const { return is_delta_; }
    const Vec3& direction() const { return d_; }
    const WalkThroughput& carried() const { return carried_; }

private:
    void advance() {
        step();
        if (going_ && at_ >= 0) {
            const double factor = roulette(carried_.largest(), random_);
            carried_.scale(factor);
            going_ = factor > 0.0;
        }
    }
    const WalkElement& element() const {
        return carried_.elements()[static_cast<std::size_t>(at_)];
    }
    void pass() { at_ += d_.z < 0.0 ? 1 : -1; }

    void step() {
        switch (element().kind) {
        case Kind::Slab:
            return cross_slab();
        case Kind::Flakes:
            return random_.next() < element().coverage ? meet_surface() : pass();
        case Kind::Conductor:
            carried_.reach();
            return meet_surface();
        case Kind::Surface:
            return meet_surface();
        case Kind::Diffuse:
            return meet_diffuse();
        }
    }

    /// Calls connect(direction index, visit) for every visit of this element.
    template <typename Connect>
    void for_visits(const Connect& connect) {
        if (!connectors_ || connectors_->size() == 0)
            return;
        const std::vector<WalkConnector>& made = connectors_->of(carried_);
        for (std::size_t k = 0; k < made.size(); ++k) {
            for (const WalkConnector::Visit& visit : made[k].visits)
                if (visit.element == static_cast<std::size_t>(at_))
                    connect(k, visit);
        }
    }
    void score(std::size_t direction, const Eigen::ArrayXd& factor) {
        carried_.add_to(tally_->directional[direction], factor);
    }

    void meet_surface() {
        const WalkSurface& surface = element().surface;
        const bool from_below = d_.z > 0.0;
        const Vec3 v = arriving(d_);
        SurfaceEvent event;
        if (surface.is_rough())
            event = meet_rough(surface, from_below, v);
        else
            event = meet_smooth_surface(surface, from_below, v, random_);
        if (tally_ && !carried_.reached())
            carried_.add_to(tally_->lost, event.lost);
        carried_.scale(event.weight);
        going_ = event.weight > 0.0;
        d_ = leaving(event.w, event.same_side == from_below);
        pass();
    }

    SurfaceEvent meet_rough(const WalkSurface& surface, bool from_below, const Vec3& v) {
        is_delta_ = false;
        std::vector<SurfaceTarget> targets;
        for_visits([&](std::size_t, const WalkConnector::Visit& visit) {
            if (can_connect(from_below, visit))
                targets.push_back({from_below == (visit.d.z > 0.0), arriving(visit.d)});
        });
        const SurfaceEvent event = meet_rough_surface(surface, from_below, v, targets, random_);
        auto target = targets.begin();
        for_visits([&](std::size_t k, const WalkConnector::Visit& visit) {
            if (can_connect(from_below, visit)) {
                const double n = surface.own_ior(visit.d.z > 0.0);
                score(k, visit.weight * ((target++)->value / (n * n)));
            }
        });
        return event;
    }
    /// Refraction upwards is the connector's own affair.
    static bool can_connect(bool from_below, const WalkConnector::Visit& visit) {
        return !from_below || visit.d.z > 0.0;
    }

    void cross_slab() {
        const WalkElement& slab = element();
        double z = d_.z < 0.0 ? 0.0 : 1.0; // share of the slab that lies above
        while (true) {
            const double c = std::max(std::fabs(d_.z), 1e-300);
            const double left = d_.z < 0.0 ? 1.0 - z : z;
            const double free_depth =
                slab.tau_scattering > 0.0 ? -std::log1p(-random_.next()) : HUGE_VAL;
            if (!(free_depth * c < slab.tau_scattering * left)) {
                carried_.absorb(slab.tau * (left / c));
                return pass();
            }
            const double path = free_depth / slab.tau_scattering;
            z = std::clamp(z + path * (d_.z < 0.0 ? c : -c), 0.0, 1.0);
            carried_.absorb(slab.tau * path);
            scatter_in_slab(slab, z);
            const double factor = roulette(carried_.largest(), random_);
            carried_.scale(factor);
            going_ = factor > 0.0;
            if (!going_)
                return;
        }
    }

    void scatter_in_slab(const WalkElement& slab, double z) {
        is_delta_ = false;
        for_visits([&](std::size_t k, const WalkConnector::Visit& visit) {
            const double c = std::max(std::fabs(visit.d.z), 1e-300);
            const double depth = visit.d.z < 0.0 ? z : 1.0 - z;
            const double phase =
                kernels::henyey_greenstein_phase(slab.anisotropy, -kernels::vec3_dot(d_, visit.d));
            score(k, visit.weight * (-(slab.tau + slab.tau_scattering) * (depth / c)).exp() *
                         (phase / (c * slab.ior * slab.ior)));
        });
        const double u1 = random_.next(), u2 = random_.next();
        d_ = kernels::henyey_greenstein_sample(d_, slab.anisotropy, u1, u2);
    }

    void meet_diffuse() {
        is_delta_ = false;
        carried_.reach();
        const Vec3 v = arriving(d_);
        carried_.re_radiate(random_);
        const WalkElement& substrate = element();
        for_visits([&](std::size_t k, const WalkConnector::Visit& visit) {
            const double value = kernels::oren_nayar_value(substrate.sigma, v, arriving(visit.d));
            score(k, visit.weight * (value / (substrate.ior * substrate.ior)));
        });
        const double c2 = random_.next(), phi = 2.0 * std::numbers::pi * random_.next();
        const double s = std::sqrt(1.0 - c2);
        d_ = kernels::vec3(s * std::cos(phi), s * std::sin(phi), std::sqrt(c2));
        carried_.scale(std::numbers::pi * kernels::oren_nayar_value(substrate.sigma, v, d_));
        going_ = carried_.largest() > 0.0;
        --at_;
    }

    WalkThroughput carried_;
    WalkRandom& random_;
    Connectors* connectors_;
    WalkTally* tally_;
    Vec3 d_;
    int at_ = 0;
    bool going_ = true;
    bool is_delta_ = true;
};

WalkTally::Parts empty_parts(const WalkMaterial& material) {
    const Eigen::Index n = material.bands();
    return {Eigen::MatrixXd::Zero(n, material.is_fluorescent() ? n : 1), Eigen::VectorXd::Zero(n)};
}

void check_direction(const Vec3& w) {
    // a direction that comes along the surface brings no light
    if (!(w.z > 0.0))
        throw std::invalid_argument("a walk needs directions above the surface");
}

} // namespace

void WalkTally::set_zero() {
    const auto clear = [](Parts& parts) {
        parts.diffuse.setZero();
        parts.specular.setZero();
    };
    clear(hemispherical);
    for (Parts& parts : directional)
        clear(parts);
    delta.setZero();
    lost.setZero();
}

LayerWalk::LayerWalk(const LayerStack& stack, const SubstrateValues& substrate,
                     const std::vector<double>& wavelengths_nm)
    : material_(stack, substrate, wavelengths_nm) {}

WalkTally LayerWalk::tally(std::size_t directions) const {
    return {empty_parts(material_),
            std::vector<WalkTally::Parts>(directions, empty_parts(material_)),
            Eigen::VectorXd::Zero(bands()), Eigen::VectorXd::Zero(bands())};
}

void LayerWalk::eval(const Vec3& wi, std::span<const Vec3> wo, std::uint64_t seed,
                     std::uint64_t sample, WalkTally& tally) const {
    check_direction(wi);
    std::for_each(wo.begin(), wo.end(), check_direction);
    Connectors connectors(wo, seed, sample);
    const auto follow = [&](std::optional<int> band) {
        WalkRandom random(seed, sample, 0); // the same at all bands: their differences are smooth
        Walk walk(WalkThroughput(material_, band), wi, random, &connectors, &tally);
        walk.run();
        if (walk.has_left()) {
            walk.carried().add_to(tally.hemispherical,
                                  Eigen::ArrayXd::Ones(walk.carried().rows().size()));
            if (walk.is_delta())
                walk.carried().add_to(tally.delta, 1.0);
        }
    };
    if (serves_all_bands()) {
        follow(std::nullopt);
        return;
    }
    for (int band = 0; band < bands(); ++band)
        follow(band);
}

WalkSample LayerWalk::sample(const Vec3& wi, int band, WalkRandom& random) const {
    check_direction(wi);
    Walk walk(WalkThroughput(material_, band), wi, random, nullptr, nullptr);
    walk.run();
    return {walk.direction(), walk.carried().band(),
            walk.has_left() ? walk.carried().rows()(0) : 0.0, walk.carried().reached(),
            walk.is_delta()};
}

WalkArrival LayerWalk::arrival(const Vec3& wi, WalkRandom& random) const {
    check_direction(wi);
    Walk walk(WalkThroughput(material_, 0), wi, random, nullptr, nullptr);
    if (!walk.run_to_substrate())
        return {};
    return {arriving(walk.direction()), walk.carried().rows()(0)};
}

LayerWalk LayerWalk::reversed() const {
    return LayerWalk(material_.reversed());
}

} // namespace reradiant
