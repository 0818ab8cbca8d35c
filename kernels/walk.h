// The model `walk`: a position-free random walk through a stack of interfaces and slabs (after Guo,
// Hasan and Zhao 2018), from the camera's direction down and back to the air. Which paths it counts
// by looking for a light and which by finding one is told in walk_light.h.
//
// The walk is scalar: directions, and weights of what does not depend on wavelength. What does is
// recorded as events (walk_events.h), which `gather` replays backwards on all lanes at once, so
// that re-radiation acts inside the walk at the cost of one operator a meeting. Interfaces are
// walked through with reciprocal scattering as if the camera sent light: directions then follow f
// cos for radiance that comes back, the factors n^2 of refraction cancel between air and air, and
// for a connection below are in the light's fluence.
#ifndef RERADIANT_WALK_H
#define RERADIANT_WALK_H

#include "kernels/features.h"
#include "kernels/layer_stack.h"
#include "kernels/oren_nayar.h"
#include "kernels/portable.h"
#include "kernels/sampling.h"
#include "kernels/shared.h"
#include "kernels/walk_events.h"
#include "kernels/walk_interface.h"
#include "kernels/walk_light.h"

/// Steps that a walk makes before each one is put under roulette, and what survives it: it bounds
/// the time where nothing absorbs.
#define WALK_FREE_STEPS 200u
#define WALK_STEP_SURVIVAL 0.95f
/// Below this guess of what it carries a walk is put under roulette, and survives at least at the
/// second.
#define WALK_ROULETTE 0.5f
#define WALK_LEAST_SURVIVAL 0.05f

typedef struct {
    WalkStack stack;
    WalkPosition at;
    const WalkArrival* arrivals; ///< of the light (WALK_PLACES)
    WalkWriter writer;
    WalkRandom random;
    float weight;
    float expected; ///< weight times the mean of what events take from the lanes
    int is_delta;   ///< smooth surfaces alone so far
    uint steps;
    uint reference; ///< which extinction scattering distances are sampled with
    float log_densities[WALK_REFERENCES]; ///< of all distances so far, under each
} Walk;

/// How a walk ended: direction in air, and weight of the radiance that comes from there.
typedef struct {
    Vec3 direction;
    float weight; ///< 0: it ended inside
    float expected;
    int is_delta;
} WalkEnd;

/// The balance heuristic over the extinctions that the walk might have taken (one is drawn per
/// walk): 1 where no slab scatters. Bounds the weights of lanes that scatter unlike the drawn one.
float walk_balance(const Walk* walk) {
#if FEATURE_SCATTERING_SLABS
    float sum = 0.0f;
    for (uint r = 0u; r < WALK_REFERENCES; ++r)
        sum += exp(walk->log_densities[r] - walk->log_densities[walk->reference]);
    return WALK_REFERENCES / sum;
#else
    return 1.0f;
#endif
}

/// Records that the light's arrival is seen from here with a density (1/sr, cosine included).
/// Returns 0 when nothing is; else events of the light's way may follow.
int walk_connect(Walk* walk, const WalkArrival* light, float density) {
    const float value = walk->weight * density * light->fluence * walk_balance(walk);
    if (!(value > 0.0f))
        return 0;
    walk_write(&walk->writer, WALK_CODE(WALK_CONNECT, 0u), value);
    for (uint k = 0u; k < walk->stack.count; ++k)
        if (light->lengths[k] > 0.0f && walk->stack.parts[k].extinction != NO_INDEX)
            walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_PASS, k), light->lengths[k]);
    for (uint i = 0u; i < light->mirrors; ++i)
        walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_REFLECT, walk->stack.count),
                   light->mirror_cosine);
    return 1;
}

/// Russian roulette by the guess of what is left, and by the number of steps.
int walk_survives(Walk* walk) {
    float survival = walk->steps > WALK_FREE_STEPS ? WALK_STEP_SURVIVAL : 1.0f;
    if (walk->expected < WALK_ROULETTE)
        survival *= fmax(walk->expected, WALK_LEAST_SURVIVAL);
    if (!(survival < 1.0f))
        return 1;
    walk->weight /= survival;
    walk->expected /= survival;
    return walk_uniform(&walk->random) < survival;
}

/// An interface; returns 0 where the walk ends.
int walk_meets_interface(Walk* walk) {
    const uint k = walk_interface_ahead(walk->at);
    const int down = walk->at.down;
    const WalkSurface surface = walk_surface(walk->stack, k, !down);
    const WalkArrival* above = walk->arrivals + WALK_AT_INTERFACE(k, 1);
    const WalkArrival* below = walk->arrivals + WALK_AT_INTERFACE(k, 0);
    const WalkArrival* same = down ? above : below;
    WalkTargets targets = walk_no_targets();
    const int is_rough = walk_is_rough(surface);
    if (is_rough) {
        targets.has_same = same->fluence > 0.0f;
        targets.has_beyond = down && below->fluence > 0.0f; // up: the light comes down by itself
        targets.same = same->v;
        targets.beyond = below->v;
    }
    const WalkDeparture departure = walk_interface(surface, walk->at.v, targets, &walk->random);
    if (targets.has_same)
        walk_connect(walk, same, departure.same_density);
    if (targets.has_beyond)
        walk_connect(walk, below, departure.beyond_density);
    walk->is_delta = walk->is_delta && !is_rough;
    walk->weight *= departure.weight;
    walk_go_on(&walk->at, departure);
    return walk->weight > 0.0f && walk->at.v.z > 0.0f;
}

/// A diffuse substrate: M is an event, cos / pi or Oren and Nayar's shape are weights.
int walk_meets_diffuse(Walk* walk) {
    const WalkArrival* light = walk->arrivals + WALK_AT_SUBSTRATE;
    const Vec3 v = walk->at.v;
    const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
    WalkDeparture departure = walk_departure();
    departure.direction = sampling_cosine(u1, u2);
    float towards_light = INV_PI_REAL;
#if FEATURE_OREN_NAYAR
    if (walk->stack.sigma > 0.0f) {
        towards_light = oren_nayar_value(walk->stack.sigma, light->v, v);
        departure.weight = PI_REAL * oren_nayar_value(walk->stack.sigma, departure.direction, v);
    }
#endif
    walk_write(&walk->writer, WALK_CODE(WALK_SUBSTRATE, 0u), 1.0f);
    if (light->fluence > 0.0f)
        walk_connect(walk, light, towards_light * light->v.z);
    walk->is_delta = 0;
    walk->weight *= departure.weight;
    walk->expected *= departure.weight * walk->stack.parts[walk->stack.count].albedo;
    walk_go_on(&walk->at, departure);
    return walk->weight > 0.0f && walk->at.v.z > 0.0f && walk_survives(walk);
}

#if FEATURE_TABULATED_REFLECTANCE
/// A rough conductor (substrate or flake) that the walk meets: its part, and the light there.
typedef struct {
    WalkSurface surface;
    uint part;
    const WalkArrival* light;
} WalkMirror;

/// A facet of a conductor reflects into the light's direction.
void walk_connect_by_facet(Walk* walk, WalkMirror mirror, Vec3 v, float density) {
    if (walk_connect(walk, mirror.light, density))
        walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_REFLECT, mirror.part),
                   vec3_dot(v, walk_half_reflected(v, mirror.light->v)));
}

void walk_reflect_by_facet(Walk* walk, uint part, float cosine) {
    walk_write(&walk->writer, WALK_CODE(WALK_REFLECT, part), cosine);
    walk->expected *= walk->stack.parts[part].albedo;
}

void walk_connect_one_facet(Walk* walk, WalkMirror mirror) {
    const Vec3 v = walk->at.v, l = mirror.light->v;
    if (mirror.light->fluence > 0.0f)
        walk_connect_by_facet(
            walk, mirror, v,
            l.z * microfacet_reflection(mirror.surface.distribution, mirror.surface.alpha, v, l));
}

int walk_reflect_by_one_facet(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    const Vec3 v = walk->at.v;
    const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
    const Vec3 h = walk_sample_facet(mirror.surface, v, u1, u2, walk_uniform(&walk->random));
    const float cos_i = vec3_dot(v, h);
    departure->direction = walk_reflected(v, h);
    if (!(cos_i > 0.0f) || !(departure->direction.z > 0.0f))
        return 0;
    walk->weight *= walk_single_share(mirror.surface, v, h, departure->direction, cos_i);
    walk_reflect_by_facet(walk, mirror.part, cos_i);
    return 1;
}

/// One facet of a rough conductor.
int walk_single_conductor(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    walk_connect_one_facet(walk, mirror);
    return walk_reflect_by_one_facet(walk, mirror, departure);
}

/// V-cavities of a conductor: one facet, or what they lose given back.
int walk_cavity_conductor(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    const float cosine = walk->at.v.z, lost = walk_cavity_lost(mirror.surface, 0, cosine);
    walk_connect_one_facet(walk, mirror);
    if (walk_connect(walk, mirror.light,
                     walk_cavity_density(mirror.surface, cosine, 0, mirror.light->v.z)))
        walk_write(&walk->writer, WALK_CODE(WALK_LIGHT_BOUNCE, mirror.part), 0.0f);
    if (!(walk_uniform(&walk->random) < lost)) {
        walk->weight /= 1.0f - lost;
        return walk_reflect_by_one_facet(walk, mirror, departure);
    }
    const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
    int passed;
    departure->direction =
        walk_cavity_departure(mirror.surface, u1, u2, walk_uniform(&walk->random), &passed);
    walk_write(&walk->writer, WALK_CODE(WALK_BOUNCE, mirror.part), 0.0f);
    walk->expected *= walk->stack.parts[mirror.part].albedo;
    return 1;
}

/// The walk between the facets of a conductor.
int walk_smith_conductor(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    WalkBetweenFacets facets =
        walk_between_facets(mirror.surface, walk->at.v, walk_uniform(&walk->random));
    for (;;) {
        if (mirror.light->fluence > 0.0f)
            walk_connect_by_facet(walk, mirror, facets.v,
                                  walk_density_back(&facets, mirror.light->v));
        const float u1 = walk_uniform(&walk->random), u2 = walk_uniform(&walk->random);
        const Vec3 h =
            microfacet_sample(mirror.surface.distribution, mirror.surface.alpha, facets.v, u1, u2);
        const float cos_i = vec3_dot(facets.v, h);
        if (!(cos_i > 0.0f))
            return 0;
        walk_reflect_by_facet(walk, mirror.part, cos_i);
        if (!walk_late_survives(facets.order, &walk->random, &walk->weight))
            return 0;
        if (walk_to_next_facet(&facets, h, 0, walk_uniform(&walk->random), &departure->direction))
            return 1;
    }
}

int walk_rough_conductor(Walk* walk, WalkMirror mirror, WalkDeparture* departure) {
    walk->is_delta = 0;
    if (!mirror.surface.multiple)
        return walk_single_conductor(walk, mirror, departure);
    return mirror.surface.distribution == MICROFACET_BLINN
               ? walk_cavity_conductor(walk, mirror, departure)
               : walk_smith_conductor(walk, mirror, departure);
}

/// A conductor, lit from `place`.
int walk_meets_conductor(Walk* walk, uint part, uint place) {
    const WalkMirror mirror = {walk_surface(walk->stack, part, 0), part, walk->arrivals + place};
    WalkDeparture departure = walk_departure();
    if (!(mirror.surface.alpha > 0.0f)) {
        departure.direction = vec3(-walk->at.v.x, -walk->at.v.y, walk->at.v.z);
        walk_reflect_by_facet(walk, part, walk->at.v.z);
    } else if (!walk_rough_conductor(walk, mirror, &departure)) {
        return 0;
    }
    walk_go_on(&walk->at, departure);
    return walk->weight > 0.0f && walk->at.v.z > 0.0f && walk_survives(walk);
}

/// Whether a flake lies where the walk comes to the end of its slab, or sets out from there.
int walk_finds_flake(Walk* walk) {
    const uint slab = walk->at.medium - 1u;
    return walk->stack.parts[slab].flakes != NO_INDEX &&
           walk_uniform(&walk->random) < walk->stack.parts[slab].coverage;
}

int walk_meets_flake(Walk* walk) {
    const uint slab = walk->at.medium - 1u;
    ++walk->steps;
    return walk_meets_conductor(walk, walk->stack.parts[slab].flakes,
                                WALK_AT_FLAKES(slab, walk->at.down));
}
#endif

#if FEATURE_SCATTERING_SLABS
/// Deflected by Henyey and Greenstein 1941: 1 - cos = (1 - g) (1 - u) (s + 1 - g) / (1 - g + 2 g
/// u), s = (1 - g) (1 + g) / (1 - g + 2 g u), which divides by no g and keeps its digits near g
/// = 1.
Vec3 walk_deflected(Vec3 direction, float g, float u1, float u2) {
    const float d = (1.0f - g) + 2.0f * g * u1;
    const float s = (1.0f - g) * (1.0f + g) / d;
    const float fall = fmin((1.0f - g) * (1.0f - u1) * (s + (1.0f - g)) / d, 2.0f);
    const float sine = sqrt(fall * (2.0f - fall));
    const float phi = 2.0f * PI_REAL * u2;
    return vec3_normalise(sampling_to_world(sampling_frame(direction),
                                            vec3(sine * cos(phi), sine * sin(phi), 1.0f - fall)));
}

/// Connects a scattering event at a height (0: top of the slab, 1: its end) to the light that
/// passes there; w: where the walk comes from.
void walk_connect_in_slab(Walk* walk, uint k, float height, Vec3 back) {
    for (int down = 0; down < 2; ++down) {
        const WalkArrival* light = walk->arrivals + WALK_IN_SLAB(k, down);
        if (!(light->fluence > 0.0f))
            continue;
        const Vec3 l = down ? light->v : walk_mirrored(light->v);
        // light comes along -l and leaves along `back`
        if (walk_connect(walk, light,
                         layer_stack_phase(walk->stack.parts[k].anisotropy, -vec3_dot(l, back))))
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

/// Through a slab that scatters, from one of its ends to one of its ends.
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
        const Vec3 w = walk_deflected(vec3_scale(back, -1.0f), part.anisotropy, u1, u2);
        walk->at.down = w.z < 0.0f;
        walk->at.v = vec3(-w.x, -w.y, fabs(w.z));
        walk->is_delta = 0;
        walk->expected *= part.albedo;
        ++walk->steps;
        if (!(walk->at.v.z > 0.0f) || !walk_survives(walk))
            return 0;
    }
}
#endif

/// Through the slab of the medium to its end.
int walk_cross_slab(Walk* walk) {
    const uint k = walk->at.medium - 1u;
    const WalkPartRecord part = walk->stack.parts[k];
#if FEATURE_SCATTERING_SLABS
    if (part.scattering != NO_INDEX)
        return walk_scatter_in_slab(walk, k, part);
#endif
    if (part.extinction != NO_INDEX) {
        walk_write_pass(&walk->writer, k, 1.0f / walk->at.v.z);
        walk->expected *= exp(-part.least_depth / walk->at.v.z);
    }
    return 1;
}

/// On to the next interface or the substrate, through the medium's slab and the flakes at its lower
/// end.
int walk_cross(Walk* walk) {
    if (walk->at.medium == 0u)
        return 1;
#if FEATURE_TABULATED_REFLECTANCE
    if (!walk->at.down && walk_finds_flake(walk))
        return walk_meets_flake(walk);
    for (;;) {
        if (!walk_cross_slab(walk))
            return 0;
        if (!walk->at.down || !walk_finds_flake(walk))
            return 1;
        if (!walk_meets_flake(walk))
            return 0;
    }
#else
    return walk_cross_slab(walk);
#endif
}

int walk_meets_substrate(Walk* walk) {
#if FEATURE_TABULATED_REFLECTANCE
    if (walk->stack.parts[walk->stack.count].reflectance != NO_INDEX)
        return walk_meets_conductor(walk, walk->stack.count, WALK_AT_SUBSTRATE);
#endif
    return walk_meets_diffuse(walk);
}

/// The walk of a camera that looks along -wo (wo above the surface), connected to `arrivals`.
WalkEnd walk_stack(Walk* walk, Vec3 wo) {
    walk->at.v = wo;
    walk->at.medium = 0u;
    walk->at.down = 1;
    walk->weight = walk->expected = 1.0f;
    walk->is_delta = 1;
    walk->reference = 0u;
#if FEATURE_SCATTERING_SLABS
    walk->reference = (uint)(walk_uniform(&walk->random) * (float)WALK_REFERENCES);
    for (uint r = 0u; r < WALK_REFERENCES; ++r)
        walk->log_densities[r] = 0.0f;
#endif
    WalkEnd end = {vec3(0.0f, 0.0f, 1.0f), 0.0f, 0.0f, 0};
    for (walk->steps = 0u; walk->at.down || walk->at.medium > 0u; ++walk->steps) {
        const int goes_on = walk->at.down && walk->at.medium == walk->stack.count
                                ? walk_meets_substrate(walk)
                                : walk_meets_interface(walk);
        if (!goes_on || !walk_cross(walk))
            return end;
    }
    end.direction = vec3(-walk->at.v.x, -walk->at.v.y, walk->at.v.z);
    end.weight = walk->weight * walk_balance(walk);
    end.expected = walk->expected;
    end.is_delta = walk->is_delta;
    return end;
}

#endif
