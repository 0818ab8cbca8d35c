#include "host/layers/walk/walk.h"

#include "host/layers/walk/guided_light.h"
#include "host/layers/walk/walk_connector.h"
#include "host/layers/walk/walk_throughput.h"
#include "kernels/scatter/henyey_greenstein.h"
#include "kernels/scatter/oren_nayar.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace reradiant {

using kernels::Vec3;
using Kind = WalkElement::Kind;

namespace {

/// One walk from the air until it ends or leaves.
class Walk {
public:
    Walk(WalkThroughput carried, const Vec3& wi, WalkRandom& random, WalkConnectors* connectors,
         WalkTally* tally)
        : carried_(std::move(carried)), random_(random), connectors_(connectors), tally_(tally),
          d_(kernels::vec3(-wi.x, -wi.y, -wi.z)), at_(wi.z > 0.0 ? 0 : last()) {}

    void run() {
        while (going_ && is_inside())
            advance();
    }
    /// Goes on until the light meets a diffuse substrate; false where it does not.
    bool run_to_substrate() {
        while (going_ && is_inside() && element().kind != Kind::Diffuse)
            advance();
        return going_ && is_inside();
    }
    bool has_left() const { return going_; }
    bool is_delta() const { return is_delta_; }
    const Vec3& direction() const { return d_; }
    const WalkThroughput& carried() const { return carried_; }

private:
    int last() const { return static_cast<int>(carried_.elements().size()) - 1; }
    bool is_inside() const { return at_ >= 0 && at_ <= last(); }
    const WalkElement& element() const {
        return carried_.elements()[static_cast<std::size_t>(at_)];
    }
    void pass() { at_ += d_.z < 0.0 ? 1 : -1; }

    void advance() {
        step();
        if (going_ && is_inside())
            play_roulette();
    }
    void play_roulette() {
        const double factor = roulette(carried_.largest(), random_);
        carried_.scale(factor);
        going_ = factor > 0.0;
    }

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

    /// Calls connect(direction index, visit) for every visit of this element that `is_connected`
    /// (connector, visit).
    template <typename IsConnected, typename Connect>
    void for_visits(const IsConnected& is_connected, const Connect& connect) {
        if (!connectors_ || connectors_->size() == 0)
            return;
        const std::vector<WalkConnector>& made = connectors_->of(carried_);
        for (std::size_t k = 0; k < made.size(); ++k) {
            for (const WalkConnector::Visit& visit : made[k].visits)
                if (visit.element == static_cast<std::size_t>(at_) && is_connected(made[k], visit))
                    connect(k, visit);
        }
    }
    static bool always(const WalkConnector&, const WalkConnector::Visit&) { return true; }
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
        // refraction against an inward path is the connector's own affair, but for the event that
        // no other event precedes
        const auto is_connected = [from_below, is_first = is_delta_](const auto& connector,
                                                                     const auto& visit) {
            return is_first || from_below == (visit.d.z > 0.0) || !connector.goes_inwards(visit);
        };
        is_delta_ = false;
        std::vector<SurfaceTarget> targets;
        for_visits(is_connected, [&](std::size_t, const WalkConnector::Visit& visit) {
            targets.push_back({from_below == (visit.d.z > 0.0), arriving(visit.d)});
        });
        const SurfaceEvent event = meet_rough_surface(surface, from_below, v, targets, random_);
        auto target = targets.begin();
        for_visits(is_connected, [&](std::size_t k, const WalkConnector::Visit& visit) {
            const double n = surface.own_ior(visit.d.z > 0.0);
            score(k, visit.weight * ((target++)->value / (n * n)));
        });
        return event;
    }

    void cross_slab() {
        SlabEvent event{.z = d_.z < 0.0 ? 0.0 : 1.0};
        while (go_to_event(event) || (carried_.material().is_dyed() && follow_guided(event))) {
            meet_in_slab(event);
            if (going_)
                play_roulette();
            if (!going_)
                return;
        }
        if (going_)
            pass();
    }

    /// A place in a slab, and the depth of the dyes' events on the way there.
    struct SlabEvent {
        double z; ///< share of the slab that lies above
        double tau_emission = 0.0;
    };

    /// Goes through the slab to an event there, or to its end: false.
    bool go_to_event(SlabEvent& event) {
        const WalkElement& slab = element();
        const double c = std::max(std::fabs(d_.z), 1e-300);
        const double left = d_.z < 0.0 ? 1.0 - event.z : event.z;
        event.tau_emission = slab.is_dyed() ? slab.tau_emission_on(left / c) : 0.0;
        const double rate = slab.tau_scattering + event.tau_emission;
        const double free_depth = rate > 0.0 ? -std::log1p(-random_.next()) : HUGE_VAL;
        if (!(free_depth * c < rate * left)) {
            carried_.absorb((slab.tau - event.tau_emission) * (left / c));
            return false;
        }
        const double path = free_depth / rate;
        event.z = std::clamp(event.z + path * (d_.z < 0.0 ? c : -c), 0.0, 1.0);
        carried_.absorb((slab.tau - event.tau_emission) * path);
        return true;
    }

    /// Goes on to the next event of light that is guided, which may lie in another slab; false
    /// where it is not guided, or ends because there is no such event or that takes all of it away.
    bool follow_guided(SlabEvent& event) {
        const auto light =
            GuidedLight::find(carried_.elements(), static_cast<std::size_t>(at_), d_);
        if (!light)
            return false;
        const std::optional<GuidedLight::Event> next = light->next_event(random_);
        if (!next) {
            if (tally_)
                carried_.add_to(tally_->guided);
            going_ = false;
            return false;
        }
        at_ = static_cast<int>(next->element);
        d_ = next->d;
        const WalkElement& slab = element();
        event = {next->z, slab.tau_emission};
        carried_.scale((slab.tau_scattering + slab.tau_emission) /
                       (slab.tau_scattering + slab.tau(0)));
        going_ = carried_.largest() > 0.0;
        return going_;
    }

    /// Lets the slab scatter the light or its dyes re-emit it.
    void meet_in_slab(const SlabEvent& event) {
        const WalkElement& slab = element();
        carried_.spread();
        is_delta_ = false;
        const double rate = slab.tau_scattering + event.tau_emission;
        if (event.tau_emission > 0.0 && random_.next() * rate >= slab.tau_scattering) {
            carried_.re_emit(slab, event.tau_emission, random_);
            going_ = carried_.largest() > 0.0;
            if (going_)
                send_from_slab(0.0, event.z);
        } else {
            send_from_slab(slab.anisotropy, event.z);
        }
    }

    void send_from_slab(double anisotropy, double z) {
        const WalkElement& slab = element(); // in the band that the light has now
        for_visits(always, [&](std::size_t k, const WalkConnector::Visit& visit) {
            const double c = std::max(std::fabs(visit.d.z), 1e-300);
            const double depth = visit.d.z < 0.0 ? z : 1.0 - z;
            const double phase =
                kernels::henyey_greenstein_phase(anisotropy, -kernels::vec3_dot(d_, visit.d));
            score(k, visit.weight * (-(slab.tau + slab.tau_scattering) * (depth / c)).exp() *
                         (phase / (c * slab.ior * slab.ior)));
        });
        const double u1 = random_.next(), u2 = random_.next();
        d_ = kernels::henyey_greenstein_sample(d_, anisotropy, u1, u2);
    }

    void meet_diffuse() {
        is_delta_ = false;
        carried_.reach();
        const Vec3 v = arriving(d_);
        carried_.re_radiate(random_);
        const WalkElement& substrate = element();
        for_visits(always, [&](std::size_t k, const WalkConnector::Visit& visit) {
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
    WalkConnectors* connectors_;
    WalkTally* tally_;
    Vec3 d_;
    int at_;
    bool going_ = true;
    bool is_delta_ = true;
};

WalkTally::Parts empty_parts(const WalkMaterial& material) {
    const Eigen::Index n = material.bands();
    return {Eigen::MatrixXd::Zero(n, material.is_fluorescent() ? n : 1),
            Eigen::MatrixXd::Zero(n, material.is_dyed() ? n : 1), Eigen::VectorXd::Zero(n)};
}

/// Adds what a walk ends with in the air.
void add_departure(const Walk& walk, bool comes_from_above, WalkTally& tally) {
    const WalkThroughput& carried = walk.carried();
    const bool is_back = (walk.direction().z > 0.0) == comes_from_above;
    carried.add_to(is_back ? tally.hemispherical : tally.transmitted,
                   Eigen::ArrayXd::Ones(carried.rows().size()));
    if (walk.is_delta())
        carried.add_to(is_back ? tally.delta : tally.delta_transmitted, 1.0);
}

} // namespace

void WalkTally::set_zero() {
    for_arrays(*this, [](auto& array) { array.setZero(); });
}

Eigen::MatrixXd all_light(const WalkTally::Parts& parts) {
    Eigen::MatrixXd sum = parts.specular.asDiagonal();
    for (const Eigen::MatrixXd* part : {&parts.diffuse, &parts.slab}) {
        if (part->cols() == sum.cols())
            sum += *part;
        else
            sum.diagonal() += part->col(0);
    }
    return sum;
}

WalkTally LayerWalk::tally(std::size_t directions) const {
    const WalkTally::Parts parts = empty_parts(material_);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(bands());
    return {.hemispherical = parts,
            .transmitted = material_.is_sheet() ? parts : WalkTally::Parts{},
            .directional = std::vector<WalkTally::Parts>(directions, parts),
            .guided = parts.slab,
            .delta = none,
            .delta_transmitted = none,
            .lost = none};
}

void LayerWalk::check_direction(const Vec3& w) const {
    // a direction that comes along the surface brings no light
    if (!(w.z > 0.0) && !(material_.is_sheet() && w.z < 0.0))
        throw std::invalid_argument(material_.is_sheet()
                                        ? "a walk needs directions to either side of the sheet"
                                        : "a walk needs directions above the surface");
}

void LayerWalk::eval(const Vec3& wi, std::span<const Vec3> wo, std::uint64_t seed,
                     std::uint64_t sample, WalkTally& tally) const {
    check_direction(wi);
    for (const Vec3& w : wo)
        check_direction(w);
    WalkConnectors connectors(wo, seed, sample);
    const auto follow = [&](std::optional<int> band) {
        WalkRandom random(seed, sample, 0); // the same at all bands: their differences are smooth
        Walk walk(WalkThroughput(material_, band), wi, random, &connectors, &tally);
        walk.run();
        if (walk.has_left())
            add_departure(walk, wi.z > 0.0, tally);
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
