#pragma once

#include "host/layers/rough/lost_flux.h"
#include "host/layers/walk/walk_random.h"
#include "kernels/walk/walk_facets.h"
#include "reradiant/stack_elements.h"

#include <memory>
#include <span>

namespace reradiant {

/// A surface as the walk meets it at one wavelength; one that does not scatter has alpha 0.
/// Directions are given in the frame of the side that they are on: z > 0 points away from the
/// surface, and the frame below is the one above with all axes turned over.
struct WalkSurface : SurfaceValues {
    std::shared_ptr<const LostFlux> lost = nullptr; ///< set for blinn with `multiple` only
    double lost_reflectance = 1.0; ///< share of the lost flux that a conductor gives back

    bool is_rough() const { return alpha > 0.0; }
    double own_ior(bool from_below) const {
        return from_below && !is_conductor ? ior_below : ior_above;
    }
    /// Returns the reflectance (unit 1) of a facet at cos_i >= 0.
    double reflectance(bool from_below, double cos_i) const;
    /// Returns what the kernels' functions need of the facets that are seen from one side.
    kernels::WalkSurface facets(bool from_below) const;
};

WalkSurface walk_surface(const SurfaceValues& surface);

/// A `SurfaceTarget` is a direction in which the scattered light is asked for.
struct SurfaceTarget {
    bool same_side; ///< as the light that comes
    kernels::Vec3 w;
    double value = 0.0; ///< out: estimate of the BSDF without cosine, 1/sr
};

/// A `SurfaceEvent` says in which direction the walk goes on after it met a surface.
struct SurfaceEvent {
    bool same_side = true;
    kernels::Vec3 w{};
    double weight = 0.0; ///< 0: it ends here
    double lost = 0.0;   ///< share that single scattering loses
};

/// Reflects or refracts light at a smooth surface; the branch is chosen by its probability.
SurfaceEvent meet_smooth_surface(const WalkSurface& surface, bool from_below,
                                 const kernels::Vec3& v, WalkRandom& random);
/// Returns the direction refracted through a smooth interface; v.z must lie within the cone that
/// transmits.
kernels::Vec3 refract_at_smooth_surface(const WalkSurface& surface, bool from_below,
                                        const kernels::Vec3& v);

/// Scatters light that comes from v once at a rough surface and fills the values of the targets.
/// The event and the values are unbiased for the same BSDF. `single` and blinn use Walter et al.
/// 2007: masked light is lost, and the values are exact. `multiple` uses a walk on the Smith
/// microsurface with next-event estimation at every facet for ggx and beckmann (Heitz et al. 2016,
/// section 7); blinn gives back what it loses (LostFlux; conductors with the reflectance of Kulla
/// and Conty 2017).
SurfaceEvent meet_rough_surface(const WalkSurface& surface, bool from_below, const kernels::Vec3& v,
                                std::span<SurfaceTarget> targets, WalkRandom& random);

} // namespace reradiant
