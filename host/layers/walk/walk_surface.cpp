#include "host/layers/walk/walk_surface.h"

#include "host/layers/stack/quadrature.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/thin_film.h"
#include "kernels/walk/walk_cavities.h"
#include "kernels/walk/walk_microsurface.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

using kernels::Vec3;

namespace {

/// Between the frames of the two sides; so the cosine of what a facet refracts is that with its
/// normal, as if it were reflected.
Vec3 turned_over(const Vec3& w) {
    return kernels::vec3_scale(w, -1.0);
}

/// The facets of a surface that are seen from one side.
struct Side {
    const WalkSurface& surface;
    bool below;
    kernels::WalkSurface facets;

    Side(const WalkSurface& of, bool from_below)
        : surface(of), below(from_below), facets(of.facets(from_below)) {}

    Vec3 sample(const Vec3& v, WalkRandom& random) const {
        const double u1 = random.next(), u2 = random.next();
        return kernels::microfacet_sample(facets.distribution, facets.alpha, v, u1, u2);
    }
    double reflectance(double cos_i) const {
        return surface.reflectance(below, std::clamp(cos_i, 0.0, 1.0));
    }
    double reflectance(const Vec3& v, const Vec3& h) const {
        return reflectance(kernels::vec3_dot(v, h));
    }
    /// The direction in which a facet sends light, in the frame of the side where it goes.
    Vec3 leave(const Vec3& v, const Vec3& h, bool reflects) const {
        return reflects ? kernels::walk_reflected(v, h)
                        : turned_over(kernels::walk_refracted(v, h, facets.eta));
    }
    /// Flux density, 1/sr, of light from v that facets seen by v send towards w, shadowing left
    /// out.
    double density(const Vec3& v, const Vec3& w, bool reflects) const {
        if (reflects) {
            const Vec3 h = kernels::walk_half_reflected(v, w);
            return kernels::walk_reflection_density(facets, v, h, reflectance(v, h));
        }
        const kernels::WalkRefraction r = refraction(v, w);
        return r.jacobian > 0.0
                   ? kernels::walk_refraction_density(facets, v, r, 1.0 - reflectance(r.cos_i))
                   : 0.0;
    }
    /// Returns the density that single scattering lets out, times the cosine of w.
    double single_density(const Vec3& v, const Vec3& w, bool reflects) const {
        if (reflects) {
            const Vec3 h = kernels::walk_half_reflected(v, w);
            return kernels::walk_single_reflection(facets, v, w, reflectance(v, h));
        }
        const kernels::WalkRefraction r = refraction(v, w);
        return r.jacobian > 0.0 ? kernels::walk_single_refraction(facets, v, turned_over(w), r,
                                                                  1.0 - reflectance(r.cos_i))
                                : 0.0;
    }

private:
    kernels::WalkRefraction refraction(const Vec3& v, const Vec3& w) const {
        return surface.is_conductor ? kernels::WalkRefraction{}
                                    : kernels::walk_refraction(facets, v, turned_over(w));
    }
};

/// A facet's two branches: the one chosen and the weight of conductors, which have only one.
struct Branch {
    bool reflects;
    double weight;
};
Branch choose_branch(const WalkSurface& surface, double reflectance, WalkRandom& random) {
    if (surface.is_conductor)
        return {true, reflectance};
    return {random.next() < reflectance, 1.0};
}

void add_single_values(const Side& side, const Vec3& v, std::span<SurfaceTarget> targets) {
    for (SurfaceTarget& target : targets)
        target.value += side.single_density(v, target.w, target.same_side) / target.w.z;
}

/// One scattering by Smith's facets, sampled as they are seen.
SurfaceEvent scatter_once(const Side& side, const Vec3& v, WalkRandom& random) {
    const Vec3 h = side.sample(v, random);
    const double cos_v = kernels::vec3_dot(v, h);
    if (!(cos_v > 0.0))
        return {true, v, 0.0, 1.0};
    const Branch branch = choose_branch(side.surface, side.reflectance(cos_v), random);
    SurfaceEvent event;
    event.same_side = branch.reflects;
    event.w = side.leave(v, h, branch.reflects);
    const double kept =
        event.w.z > 0.0 ? kernels::walk_single_share(side.facets, v, h, event.w, cos_v) : 0.0;
    event.weight = branch.weight * kept;
    event.lost = branch.weight * (1.0 - kept);
    return event;
}

/// One scattering by V-cavities. Their facets are sampled by D alone, with weights between 0 and
/// 2 whose product would grow without bound in a white stack; one of 16 facets and their branches,
/// drawn by its weight, has a weight near 1 (resampled importance sampling, Talbot et al. 2005).
SurfaceEvent scatter_in_cavity(const Side& side, const Vec3& v, WalkRandom& random) {
    constexpr int facets = 16;
    SurfaceEvent event;
    double arrives = 0.0;
    for (int k = 0; k < facets; ++k) {
        const Vec3 h = side.sample(v, random);
        const double cos_v = kernels::vec3_dot(v, h);
        if (!(cos_v > 0.0))
            continue;
        const auto offer = [&](bool reflects, double share) {
            const Vec3 w = side.leave(v, h, reflects);
            arrives += share / facets;
            if (!(w.z > 0.0))
                return;
            const double kept =
                share / facets *
                kernels::walk_drawn_share(side.facets, v, h, w, kernels::vec3_dot(w, h));
            if (!(kept > 0.0))
                return;
            event.weight += kept;
            if (random.next() * event.weight < kept) {
                event.same_side = reflects;
                event.w = w;
            }
        };
        const double r = side.reflectance(cos_v);
        offer(true, r);
        if (!side.surface.is_conductor)
            offer(false, 1.0 - r);
    }
    event.lost = (side.surface.is_conductor ? arrives : 1.0) - event.weight;
    return event;
}

/// Single scattering of V-cavities, and what it loses given back.
SurfaceEvent scatter_and_give_back(const Side& side, const Vec3& v,
                                   std::span<SurfaceTarget> targets, WalkRandom& random) {
    const kernels::WalkSurface& facets = side.facets;
    const WalkSurface& surface = side.surface;
    for (SurfaceTarget& target : targets) {
        if (target.same_side || !surface.is_conductor)
            target.value +=
                surface.lost_reflectance *
                kernels::walk_cavity_density(facets, v.z, !target.same_side, target.w.z) /
                target.w.z;
    }
    add_single_values(side, v, targets);
    const double lost =
        kernels::walk_cavity_lost(facets, kernels::walk_cavity_is_dense(facets), v.z);
    if (random.next() >= lost) {
        SurfaceEvent event = scatter_in_cavity(side, v, random);
        event.weight /= 1.0 - lost;
        event.lost = 0.0;
        return event;
    }
    const double u1 = random.next(), u2 = random.next();
    int passed = 0;
    const Vec3 w = kernels::walk_cavity_departure(facets, u1, u2, random.next(), &passed);
    return {passed == 0, w, surface.lost_reflectance, 0.0};
}

/// Walk on the Smith microsurface of one surface.
SurfaceEvent walk_between_facets(const WalkSurface& surface, bool from_below, const Vec3& v,
                                 std::span<SurfaceTarget> targets, WalkRandom& random) {
    kernels::WalkBetweenFacets walk =
        kernels::walk_between_facets(surface.facets(from_below), v, random.next());
    double weight = 1.0;
    // most walks end after one or two facets; light trapped for 1000 is not worth following
    while (walk.order < 1000) {
        const bool passed = walk.passed != 0;
        const Side side(surface, from_below != passed);
        for (SurfaceTarget& target : targets) {
            const bool reflects = target.same_side != passed;
            const double density = side.density(walk.v, target.w, reflects);
            const double height = reflects ? walk.height : 1.0 - walk.height;
            if (density > 0.0)
                target.value += weight * density *
                                kernels::walk_escape(walk.surface, target.w, height) / target.w.z;
        }
        const Vec3 h = side.sample(walk.v, random);
        const Branch branch = choose_branch(surface, side.reflectance(walk.v, h), random);
        weight *= branch.weight;
        const Vec3 w = side.leave(walk.v, h, branch.reflects);
        if (!branch.reflects)
            kernels::walk_pass_facet(&walk);
        if (random.next() < kernels::walk_escape(walk.surface, w, walk.height))
            return {walk.passed == 0, w, weight, 0.0};
        kernels::walk_meet_facet(
            &walk, w, kernels::walk_met_height(walk.surface, w, walk.height, random.next()));
    }
    return {true, v, 0.0, 0.0};
}

/// Kulla and Conty 2017: what stays of light that bounces between the facets of a metal, whose
/// single scattering keeps the share `kept` on average.
double bounced_reflectance(const WalkSurface& surface) {
    const double mean = integrate_sin2(
        0.0, 1.0, 32, [&](double c) { return 2.0 * c * surface.reflectance(false, c); });
    const kernels::WalkSurface facets = surface.facets(false);
    const double lost = integrate_sin2(
        0.0, 1.0, 64, [&](double c) { return 2.0 * c * kernels::walk_cavity_lost(facets, 0, c); });
    const double kept = 1.0 - lost;
    return mean * mean * kept / (1.0 - mean * lost);
}

} // namespace

double WalkSurface::reflectance(bool from_below, double cos_i) const {
    const double own = own_ior(from_below);
    const double other = is_conductor || !from_below ? ior_below : ior_above;
    return kernels::thin_film_reflectance(cos_i, own, film.ior, other, kappa, film.thickness_nm,
                                          wavelength_nm);
}

kernels::WalkSurface WalkSurface::facets(bool from_below) const {
    const double other = from_below ? ior_above : ior_below;
    return {kernel_distribution(distribution),
            alpha,
            is_conductor ? 1.0 : other / own_ior(from_below),
            scattering == Scattering::Multiple,
            is_conductor,
            lost ? lost->table().data() : nullptr};
}

WalkSurface walk_surface(const SurfaceValues& values) {
    WalkSurface surface{values};
    if (!values.scatters())
        surface.alpha = 0.0;
    if (!surface.is_rough() || surface.distribution != Distribution::Blinn ||
        surface.scattering != Scattering::Multiple)
        return surface;
    if (surface.is_conductor) {
        surface.lost = LostFlux::of(0.0, surface.alpha);
        surface.lost_reflectance = bounced_reflectance(surface);
    } else {
        const double ratio = surface.ior_below / surface.ior_above;
        surface.lost = LostFlux::of(std::max(ratio, 1.0 / ratio), surface.alpha);
    }
    return surface;
}

SurfaceEvent meet_smooth_surface(const WalkSurface& surface, bool from_below, const Vec3& v,
                                 WalkRandom& random) {
    const double reflectance = surface.reflectance(from_below, std::min(v.z, 1.0));
    const Branch branch = choose_branch(surface, reflectance, random);
    return {branch.reflects,
            branch.reflects ? kernels::vec3(-v.x, -v.y, v.z)
                            : refract_at_smooth_surface(surface, from_below, v),
            branch.weight, 0.0};
}

Vec3 refract_at_smooth_surface(const WalkSurface& surface, bool from_below, const Vec3& v) {
    return kernels::fresnel_refracted(v, surface.facets(from_below).eta);
}

SurfaceEvent meet_rough_surface(const WalkSurface& surface, bool from_below, const Vec3& v,
                                std::span<SurfaceTarget> targets, WalkRandom& random) {
    if (surface.distribution != Distribution::Blinn && surface.scattering == Scattering::Multiple)
        return walk_between_facets(surface, from_below, v, targets, random);
    const Side side(surface, from_below);
    if (surface.scattering == Scattering::Multiple)
        return scatter_and_give_back(side, v, targets, random);
    add_single_values(side, v, targets);
    return surface.distribution == Distribution::Blinn ? scatter_in_cavity(side, v, random)
                                                       : scatter_once(side, v, random);
}

} // namespace reradiant
