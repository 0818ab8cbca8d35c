#include "host/layers/walk/walk_connector.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

using kernels::Vec3;
using Kind = WalkElement::Kind;

namespace {

/// One path down. `at` is the next element; paths that go up past the first one have left.
class Descent {
public:
    Descent(const WalkElements& elements, const Vec3& wo, Eigen::Index bands, WalkRandom& random)
        : elements_(elements), random_(random), d_(kernels::vec3(-wo.x, -wo.y, -wo.z)),
          weight_(Eigen::ArrayXd::Ones(bands)) {}

    WalkConnector run() {
        while (at_ >= 0 && going_) {
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

    void visit() { connector_.visits.push_back({static_cast<std::size_t>(at_), d_, weight_}); }
    void pass() { at_ += d_.z < 0.0 ? 1 : -1; }

    void pass_slab(const WalkElement& slab) {
        if (slab.tau_scattering > 0.0)
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
        const bool from_below = d_.z > 0.0;
        going_ = !from_below && element.kind == Kind::Surface;
        if (going_) {
            follow(meet_rough_surface(element.surface, from_below, arriving(d_), {}, random_));
            going_ = going_ && d_.z < 0.0;
        }
    }

    void meet_smooth(const WalkElement& element) {
        const bool from_below = d_.z > 0.0;
        const Vec3 v = arriving(d_);
        if (at_ > 0 || element.surface.is_conductor) {
            follow(meet_smooth_surface(element.surface, from_below, v, random_));
            return;
        }
        if (from_below) { // what leaves here leaves for good, so only the rest is followed
            const double back = element.surface.reflectance(true, std::min(v.z, 1.0));
            follow({true, kernels::vec3(-v.x, -v.y, v.z), back, 0.0});
            return;
        }
        const double through = 1.0 - element.surface.reflectance(false, std::min(v.z, 1.0));
        going_ = through > 0.0;
        if (going_)
            follow({false, refract_at_smooth_surface(element.surface, false, v), through, 0.0});
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
    int at_ = 0;
    bool going_ = true;
    WalkConnector connector_;
};

} // namespace

WalkConnector connect_down(const WalkElements& elements, const Vec3& wo, Eigen::Index bands,
                           WalkRandom& random) {
    return Descent(elements, wo, bands, random).run();
}

double roulette(double weight, WalkRandom& random) {
    constexpr double floor = 0.02;
    if (weight >= floor)
        return 1.0;
    return random.next() * floor < weight ? floor / weight : 0.0;
}

} // namespace reradiant
