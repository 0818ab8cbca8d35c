// A walk through a slab that scatters.
#ifndef RERADIANT_WALK_SLAB_H
#define RERADIANT_WALK_SLAB_H

#include "kernels/core/features.h"
#include "kernels/scatter/henyey_greenstein.h"
#include "kernels/walk/walk_state.h"

#if FEATURE_SCATTERING_SLABS
/// Connects a scattering event at a height (0: top of the slab, 1: its end) to the light that
/// passes there; w: where the walk comes from.
void walk_connect_in_slab(Walk* walk, uint k, float height, Vec3 back) {
    for (int down = 0; down < 2; ++down) {
        const WalkArrival* light = walk->arrivals + WALK_IN_SLAB(k, down);
        if (!(light->fluence > 0.0f))
            continue;
        const Vec3 l = down ? light->v : walk_mirrored(light->v);
        // light comes along -l and leaves along `back`
        const float density =
            henyey_greenstein_phase(walk->stack.parts[k].anisotropy, -vec3_dot(l, back));
        if (walk_connect(walk, light,
                         density * walk_connection_share(walk, light, walk->at.medium, density)))
            walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_PASS, k),
                       (down ? height : 1.0f - height) / light->v.z);
    }
}

/// Counts a way of some length in a slab, scattered at its end or not, under every extinction.
void walk_count_distance(Walk* walk, WalkPartRecord part, float length, int scattered) {
    for (uint r = 0u; r < WALK_REFERENCES; ++r)
        walk->log_densities[r] +=
            (scattered ? log(part.references[r]) : 0.0f) - part.references[r] * length;
}

/// Takes the walk through a slab that scatters, from one of its ends to one of its ends. Returns 0
/// where the walk ends inside.
int walk_scatter_in_slab(Walk* walk, uint k, WalkPartRecord part) {
    float height = walk->at.down ? 0.0f : 1.0f;
    for (;;) {
        const float to_end = (walk->at.down ? 1.0f - height : height) / walk->at.v.z;
        const float length =
            -log1p(-walk_uniform(&walk->random)) / part.references[walk->reference];
        if (!(length < to_end)) {
            walk_write_pass(&walk->writer, k, to_end);
            walk_count_distance(walk, part, to_end, 0);
            return 1;
        }
        height += (walk->at.down ? length : -length) * walk->at.v.z;
        walk_write(&walk->writer, WALK_CODE(WALK_SCATTER, k), length);
        walk_count_distance(walk, part, length, 1);
        const Vec3 back = walk->at.down ? walk->at.v : walk_mirrored(walk->at.v);
        walk_connect_in_slab(walk, k, height, back);
        const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
        const Vec3 w = henyey_greenstein_sample(vec3_scale(back, -1.0f), part.anisotropy, u1, u2);
        walk->at.down = w.z < 0.0f;
        walk->at.v = vec3(-w.x, -w.y, fabs(w.z));
        walk_leaves(walk, henyey_greenstein_phase(part.anisotropy, -vec3_dot(w, back)));
        walk->expected *= part.albedo;
        ++walk->steps;
        if (!(walk->at.v.z > 0.0f) || !walk_survives(walk))
            return 0;
    }
}
#endif

#endif
