#include "host/layers/models/returned_lobe.h"

#include "host/layers/models/lobe_ratios.h"
#include "host/layers/smooth/smooth_stack.h"
#include "host/layers/walk/walk_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace reradiant {

using kernels::Vec3;

namespace {

/// Interfaces from above: smooth ones, then the uppermost rough one and those beneath it down to
/// the last. The lobe's light reaches `first` or deeper.
struct Interfaces {
    std::vector<SurfaceValues> above, below;
    std::size_t first = 0;  ///< among `below`
    bool is_filmed = false; ///< the last one bears a film

    Interfaces(std::span<const StackElement> stack, std::size_t first_element,
               std::size_t last_element) {
        for (std::size_t e = 0; e <= last_element; ++e) {
            const auto* surface = std::get_if<SurfaceValues>(&stack[e]);
            if (!surface)
                continue;
            const bool is_above = below.empty() && !surface->scatters();
            first = e == first_element ? below.size() : first;
            (is_above ? above : below).push_back(*surface);
        }
    }

    /// The smooth ones as a pile without absorption.
    SmoothStack pile() const {
        SmoothStack pile{{1.0}, {0.0}};
        for (const SurfaceValues& surface : above) {
            pile.ior.push_back(surface.ior_below);
            pile.tau.push_back(0.0);
        }
        return pile;
    }

    std::vector<double> key() const {
        // a lobe that comes back
        std::vector<double> key{1.0, static_cast<double>(first), is_filmed ? 1.0 : 0.0};
        for (const auto* surfaces : {&above, &below}) {
            key.push_back(static_cast<double>(surfaces->size()));
            for (const SurfaceValues& surface : *surfaces)
                append_key(surface, key);
        }
        return key;
    }
};

/// Makes interfaces smooth that spread light next to nothing beside what `first` does. Walks would
/// be connected at them, and one in many would bring all of it.
void smooth_faint(StackElements& stack, std::size_t first) {
    constexpr double faint = 0.25;
    const auto& deep = std::get<SurfaceValues>(stack[first]);
    if (!deep.scatters())
        return;
    const double most = faint * 2.0 * deep.alpha * deep.ior_above;
    for (std::size_t e = 0; e < first; ++e) {
        auto* surface = std::get_if<SurfaceValues>(&stack[e]);
        const double ways = std::numbers::sqrt2; // down and up, as variances
        if (surface &&
            ways * surface->alpha * std::fabs(surface->ior_below - surface->ior_above) < most)
            surface->alpha = 0.0;
    }
}

/// The way of light down and back to the uppermost rough interface.
class ReturnWalk {
public:
    explicit ReturnWalk(const Interfaces& interfaces)
        : pile_(interfaces.pile()), ior_(pile_.ior.back()),
          ior_below_(interfaces.below.front().ior_below), first_(interfaces.first),
          is_filmed_(interfaces.is_filmed) {
        for (const SurfaceValues& surface : interfaces.below)
            surfaces_.push_back(walk_surface(surface));
    }

    /// Directions in air, as they are beneath the smooth interfaces, with the BSDF in air over that
    /// there: dw' cos' n^2 = dw cos.
    struct Targets {
        std::vector<SurfaceTarget> directions;
        std::vector<double> ways_out;
    };
    Targets targets(std::span<const Vec3> in_air) const {
        Targets made;
        for (const Vec3& w : in_air) {
            made.directions.push_back({true, refracted(w)});
            made.ways_out.push_back(smooth_response(pile_, 1.0, w.z).transmission / (ior_ * ior_));
        }
        return made;
    }

    void add(const Vec3& own, Targets& targets, WalkRandom& random, std::span<double> sums) const {
        State at{refracted(own), smooth_response(pile_, 1.0, own.z).transmission};
        at.reached = first_ == 0;
        for (int connections = 0; at.weight > least_weight;) {
            const bool connects = at.surface == 0 && at.reached;
            connections += connects ? 1 : 0;
            if (connects &&
                connections > free_connections) { // light that is trapped goes on for long
                if (random.next() < 0.5)
                    return;
                at.weight *= 2.0;
            }
            for (SurfaceTarget& target : targets.directions)
                target = {!at.from_below, target.w};
            const SurfaceEvent next =
                meet(at, connects ? targets.directions : std::span<SurfaceTarget>(), random);
            for (std::size_t t = 0; connects && t < sums.size(); ++t) {
                const SurfaceTarget& target = targets.directions[t];
                sums[t] += at.weight * targets.ways_out[t] * target.value *
                           share(at.first_turn, turn(at.from_below, at.v, false, target.w));
            }
            go_on(at, next);
        }
    }

private:
    static constexpr double least_weight = 1e-4;
    static constexpr int free_connections = 2;

    struct State {
        Vec3 v; ///< back to where light comes from, in the frame of its side of the surface ahead
        double weight;
        std::size_t surface = 0; ///< ahead
        bool from_below = false, reached = false;
        double first_turn = -1.0; ///< at the uppermost rough interface; there was none yet
    };

    /// What goes on beneath the last interface has a lobe of its own: it only reflects.
    SurfaceEvent meet(const State& at, std::span<SurfaceTarget> targets, WalkRandom& random) const {
        const WalkSurface& surface = surfaces_[at.surface];
        if (!at.from_below && at.surface + 1 == surfaces_.size())
            return surface.is_rough() ? sent_up(surface, at.v, targets, random)
                                      : mirrored(surface, at.v);
        return surface.is_rough()
                   ? meet_rough_surface(surface, at.from_below, at.v, targets, random)
                   : meet_smooth_surface(surface, at.from_below, at.v, random);
    }

    /// What a smooth interface reflects. The interference of a film changes with the wavelength,
    /// and stands in the lobe's amplitude alone.
    SurfaceEvent mirrored(const WalkSurface& surface, const Vec3& v) const {
        return {true, kernels::vec3(-v.x, -v.y, v.z),
                is_filmed_ ? 1.0 : surface.reflectance(false, v.z)};
    }

    /// What a rough interface reflects, without luck: one of many events that reflect, drawn by its
    /// weight.
    static SurfaceEvent sent_up(const WalkSurface& surface, const Vec3& v,
                                std::span<SurfaceTarget> targets, WalkRandom& random) {
        constexpr int tries = 8;
        SurfaceEvent drawn;
        for (int k = 0; k < tries; ++k) {
            const SurfaceEvent event = meet_rough_surface(
                surface, false, v, k == 0 ? targets : std::span<SurfaceTarget>(), random);
            if (!event.same_side || !(event.weight > 0.0))
                continue;
            drawn.weight += event.weight;
            if (random.next() * drawn.weight < event.weight)
                drawn.w = event.w;
        }
        drawn.weight /= tries;
        return drawn;
    }

    void go_on(State& at, const SurfaceEvent& next) const {
        const bool goes_up = next.same_side != at.from_below;
        if (at.first_turn < 0.0)
            at.first_turn = turn(at.from_below, at.v, !goes_up, next.w);
        at.weight *= next.weight;
        at.v = next.w;
        if (goes_up && at.surface == 0) { // the smooth interfaces send it back
            at.weight *= sent_back(next.w.z);
            at.v = kernels::vec3(-next.w.x, -next.w.y, next.w.z);
            at.from_below = false;
            return;
        }
        at.surface = goes_up ? at.surface - 1 : at.surface + 1;
        at.from_below = goes_up;
        at.reached = at.reached || at.surface >= first_;
    }

    /// Change of the wave vector along the uppermost rough interface, over that of air, of light
    /// from v on one side of it to w on another, in their frames.
    double turn(bool from_below, const Vec3& v, bool to_below, const Vec3& w) const {
        const double ior_v = from_below ? ior_below_ : ior_, ior_w = to_below ? ior_below_ : ior_;
        // v points back and w on; the frame below has all axes turned over
        const double sign = from_below == to_below ? 1.0 : -1.0;
        return std::hypot(ior_v * v.x + sign * ior_w * w.x, ior_v * v.y + sign * ior_w * w.y);
    }

    /// Of a path and its reverse, which are added, only that is counted whose first turn is the
    /// smaller one: what is drawn is narrow then, and what is evaluated wide.
    static double share(double first_turn, double last_turn) {
        const double rounding = 1e-9 * last_turn;
        if (first_turn < 0.0 || std::fabs(first_turn - last_turn) <= rounding)
            return 0.5;
        return first_turn < last_turn ? 1.0 : 0.0;
    }

    /// A direction in air as it is beneath the smooth interfaces; one that they reflect totally is
    /// grazing there.
    Vec3 refracted(const Vec3& w) const {
        constexpr double least2 = 1e-12;
        const double z2 = 1.0 - (1.0 - w.z) * (1.0 + w.z) / (ior_ * ior_);
        return kernels::vec3(w.x / ior_, w.y / ior_, std::sqrt(std::max(z2, least2)));
    }

    /// Share of light from beneath that the smooth interfaces send back.
    double sent_back(double cosine) const {
        if (pile_.ior.size() == 1)
            return 0.0;
        return smooth_response_g2(pile_, ior_, ior_ * ior_ * cosine * cosine).reflection_up();
    }

    SmoothStack pile_;
    double ior_, ior_below_; ///< of the media above and beneath the uppermost rough interface
    std::size_t first_;
    bool is_filmed_;
    std::vector<WalkSurface> surfaces_; ///< from that one on
};

/// A smooth interface takes the distribution of the rough one above it.
Distribution distribution_at(std::span<const StackElement> stack, std::size_t interface) {
    for (std::size_t e = interface; e > 0; --e)
        if (const auto* surface = std::get_if<SurfaceValues>(&stack[e]);
            surface && surface->alpha != 0.0)
            return surface->distribution;
    return std::get<SurfaceValues>(stack.front()).distribution;
}

bool is_of_cavities(const StackElement& element) {
    const auto* surface = std::get_if<SurfaceValues>(&element);
    return surface && surface->scatters() && surface->distribution == Distribution::Blinn;
}

} // namespace

bool has_returned_ratio(std::span<const StackElement> stack, std::size_t first, std::size_t last) {
    return deeper_lobe(stack, first).alpha != 0.0 ||
           std::ranges::none_of(stack.first(last + 1), is_of_cavities);
}

LobeShape returned_lobe(std::span<const StackElement> stack, std::size_t first, std::size_t last) {
    LobeShape lobe = deeper_lobe(stack, first);
    lobe.distribution = distribution_at(stack, first);
    if (!has_returned_ratio(stack, first, last))
        return lobe;
    lobe.distribution = Distribution::Ggx; // its tails are long enough for all
    StackElements nearby(stack.begin(), stack.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    for (StackElement& element : nearby)
        if (auto* surface = std::get_if<SurfaceValues>(&element))
            *surface = rounded(*surface);
    LobeShape plain = deeper_lobe(nearby, first);
    plain.distribution = lobe.distribution;
    smooth_faint(nearby, first);
    Interfaces interfaces(nearby, first, last);
    interfaces.is_filmed = std::get<SurfaceValues>(stack[last]).has_film();
    const ReturnWalk walk(interfaces);
    const auto aimed = [&](const Vec3& own, std::span<const Vec3> others) -> LobeWalk {
        return [&walk, own, targets = walk.targets(others)](WalkRandom& random,
                                                            std::span<double> sums) mutable {
            walk.add(own, targets, random, sums);
        };
    };
    lobe.table = lobe_ratios(plain, aimed, interfaces.key());
    lobe.table_kind = LobeShape::Table::Sum;
    return lobe;
}

} // namespace reradiant
