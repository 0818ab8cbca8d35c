#include "host/layers/walk/walk_connector.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

using kernels::Vec3;
using Kind = WalkElement::Kind;

namespace {

/// One path inwards. `at` is the next element; paths beyond the first or the last have left.
class Inroad {
public:
    Inroad(const WalkElements& elements, const Vec3& wo, Eigen::Index bands, WalkRandom& random)
        : elements_(elements), random_(random), d_(kernels::vec3(-wo.x, -wo.y, -wo.z)),
          weight_(Eigen::ArrayXd::Ones(bands)), entry_(wo.z > 0.0 ? 0 : last()), at_(entry_) {
        connector_.from_above = wo.z > 0.0;
    }

    WalkConnector run() {
        while (going_ && at_ >= 0 && at_ <= last()) {
            step(elements_[static_cast<std::size_t>(at_)]);
            if (going_) {
                const double factor = roulette(weight_.maxCoeff(), random_);
                weight_ *= factor;
                going_ = factor > 0.0;
            }
        }
        return std::move(connector_);
    }

private:
    void step(const WalkElement& element) {
        switch (element.kind) {
        case Kind::Slab:
            return pass_slab(element);
        case Kind::Flakes:
            return pass_flakes(element);
        case Kind::Diffuse:
            visit();
            going_ = false;
            return;
        case Kind::Surface:
        case Kind::Conductor:
            return element.surface.is_rough() ? meet_rough(element) : meet_smooth(element);
        }
    }

    int last() const { return static_cast<int>(elements_.size()) - 1; }
    bool goes_inwards() const { return (d_.z < 0.0) == connector_.from_above; }
    void visit() { connector_.visits.push_back({static_cast<std::size_t>(at_), d_, weight_}); }
    void pass() { at_ += d_.z < 0.0 ? 1 : -1; }

    void pass_slab(const WalkElement& slab) {
        if (slab.spreads())
            visit();
        weight_ *= (-(slab.tau + slab.tau_scattering) / std::max(std::fabs(d_.z), 1e-300)).exp();
        pass();
    }

    void pass_flakes(const WalkElement& flakes) {
        if (flakes.surface.is_rough()) {
            visit();
            weight_ *= 1.0 - flakes.coverage;
            pass();
        } else if (random_.next() < flakes.coverage) {
            meet_smooth(flakes);
        } else {
            pass();
        }
    }

    void meet_rough(const WalkElement& element) {
        visit();
        going_ = goes_inwards() && element.kind == Kind::Surface;
        if (going_) {
            follow(meet_rough_surface(element.surface, d_.z > 0.0, arriving(d_), {}, random_));
            going_ = going_ && goes_inwards();
        }
    }

    void meet_smooth(const WalkElement& element) {
        const bool from_below = d_.z > 0.0;
        const Vec3 v = arriving(d_);
        const bool is_outer = !element.surface.is_conductor && at_ == (from_below ? 0 : last());
        if (at_ == entry_ && goes_inwards() && !element.surface.is_conductor) {
            const double through =
                1.0 - element.surface.reflectance(from_below, std::min(v.z, 1.0));
            going_ = through > 0.0;
            if (going_)
                follow({false, refract_at_smooth_surface(element.surface, from_below, v), through,
                        0.0});
        } else if (is_outer) { // what leaves here leaves for good, so only the rest is followed
            const double back = element.surface.reflectance(from_below, std::min(v.z, 1.0));
            follow({true, kernels::vec3(-v.x, -v.y, v.z), back, 0.0});
        } else {
            follow(meet_smooth_surface(element.surface, from_below, v, random_));
        }
    }

    void follow(const SurfaceEvent& event) {
        weight_ *= event.weight;
        going_ = event.weight > 0.0;
        d_ = leaving(event.w, event.same_side == (d_.z > 0.0));
        pass();
    }

    const WalkElements& elements_;
    WalkRandom& random_;
    Vec3 d_;
    Eigen::ArrayXd weight_;
    int entry_, at_;
    bool going_ = true;
    WalkConnector connector_;
};

} // namespace

WalkConnector connect_inwards(const WalkElements& elements, const Vec3& wo, Eigen::Index bands,
                              WalkRandom& random) {
    return Inroad(elements, wo, bands, random).run();
}

const std::vector<WalkConnector>& WalkConnectors::of(const WalkThroughput& carried) {
    if (made_.empty() || band_ != carried.band()) {
        made_.clear();
        band_ = carried.band();
        for (std::size_t k = 0; k < wo_.size(); ++k) {
            WalkRandom random(seed_, sample_, k + 1); // the same at all bands
            made_.push_back(
                connect_inwards(carried.elements(), wo_[k], carried.rows().size(), random));
        }
    }
    return made_;
}

double roulette(double weight, WalkRandom& random) {
    constexpr double floor = 0.02;
    if (weight >= floor)
        return 1.0;
    return random.next() * floor < weight ? floor / weight : 0.0;
}

} // namespace reradiant
