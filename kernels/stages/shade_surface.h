// Defines what `shade` reads of the scene and what a step of a path is, and finds the point of a
// surface that the path has met.
#ifndef RERADIANT_SHADE_SURFACE_H
#define RERADIANT_SHADE_SURFACE_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/random.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"
#include "kernels/scene/texture.h"
#include "kernels/stages/rays.h"

/// Random dimensions of textures, far from those of lights and directions.
#define TEXTURE_DIMENSION 0x40000000u

/// A `ShadeScene` holds what the stage `shade` reads of the scene.
typedef struct {
    __global const MaterialRecord* materials;
    __global const LayerRecord* layers;
    __global const LobeRecord* lobes;
    __global const SurfaceRecord* surfaces;
    __global const TextureRecord* textures;
    __global const LightRecord* lights;
    __global const float* tables;
    __global const WalkPartRecord* walk_parts;
    __global WalkChunk* walk_chunks; ///< where walks keep their events: so many, and those in use
    __global uint* walk_chunks_used;
    uint walk_room;
    RenderRecord render;
} ShadeScene;

/// A `ShadeStep` is what one step of a path knows when it begins (`ray`, `hit`, `state`, `depth`),
/// and what it leaves: a vertex, with what is kept beside it, a shadow ray and the ray along which
/// the path goes on, both inactive where there are none.
typedef struct {
    HitRecord hit;
    PathState state;
    uint depth;
    RayRecord ray, next, shadow;
    VertexRecord vertex;
    WalkVertexRecord walk;
    __global float* colour;       ///< VERTEX_COLOURS of the vertex
    __global float* lobe_weights; ///< [2][LOBES] of the vertex: along `next`, towards the light
} ShadeStep;

/// A step before anything was found: no light, no way to go on.
ShadeStep shade_step(RayRecord ray, HitRecord hit, PathState state, uint depth) {
    const DirectionRecord nothing = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    const VertexRecord empty = {NO_INDEX, NO_INDEX, 0.0f, NO_INDEX, 0.0f,
                                0.0f,     1.0f,     0u,   nothing,  nothing};
    const WalkVertexRecord none = {NO_INDEX, 0u, 0u, 0.0f};
    const ShadeStep step = {hit,   state, depth, ray, ray_inactive(), ray_inactive(),
                            empty, none,  0,     0};
    return step;
}

/// A `SurfacePoint` is the point at which a path meets a material, with a local frame on the side
/// that the ray came from.
typedef struct {
    Frame frame;
    Vec3 geometric; ///< normal on the side of the camera
    Vec3 wo;        ///< towards the camera, local
    uint material;
    int is_sheet; ///< light may leave on the far side, too
} SurfacePoint;

#if FEATURE_TEXTURES || FEATURE_REFLECTANCE_IMAGE
TexturePoint texture_here(const ShadeScene* scene, uint texture, HitRecord hit) {
    return texture_at(scene->textures[texture], hit_position(hit), hit.u, hit.v, scene->tables);
}
#endif

#if FEATURE_TEXTURES
/// The normal tilted by two slopes, along the horizontal on the surface and across it.
Vec3 tilted_normal(Vec3 normal, real slope_x, real slope_y) {
    const Vec3 horizontal = vec3(normal.z, 0.0f, -normal.x); // +y cross normal
    const real size2 = vec3_dot(horizontal, horizontal);
    const Vec3 tangent =
        size2 > 1e-12f ? vec3_scale(horizontal, 1.0f / sqrt(size2)) : vec3(1.0f, 0.0f, 0.0f);
    const Vec3 bitangent = vec3_cross(normal, tangent);
    return vec3_normalise(
        vec3_add(normal, vec3_add(vec3_scale(tangent, slope_x), vec3_scale(bitangent, slope_y))));
}

/// The share of the other surface in a mixture, here.
real mixture_weight(const ShadeScene* scene, SurfaceRecord surface, HitRecord hit) {
    return surface.mix_texture == NO_INDEX ? surface.mix_weight
                                           : texture_here(scene, surface.mix_texture, hit).value;
}

#if FEATURE_NESTED_MIXTURES
/// One of the surfaces that mixtures of mixtures hold, picked by a uniform number, of which what is
/// left picks again.
SurfaceRecord choose_nested_surface(const ShadeScene* scene, SurfaceRecord surface, HitRecord hit,
                                    real u) {
    while (surface.mixed_with != NO_INDEX) {
        const real weight = mixture_weight(scene, surface, hit);
        if (!(u < weight))
            return surface;
        u /= weight;
        surface = scene->surfaces[surface.mixed_with];
    }
    return surface;
}
#endif

/// The material of a surface at a point, one level of each texture picked by u.a, u.b, u.c, a
/// mixture's side by u.d; *normal is tilted where the surface says so.
uint choose_material(const ShadeScene* scene, HitRecord hit, Random4 u, Vec3 to_camera,
                     Vec3* normal) {
    SurfaceRecord surface = scene->surfaces[hit.material];
#if FEATURE_NESTED_MIXTURES
    surface = choose_nested_surface(scene, surface, hit, u.d);
#else
    if (surface.mixed_with != NO_INDEX && u.d < mixture_weight(scene, surface, hit))
        surface = scene->surfaces[surface.mixed_with];
#endif
    const real random[MAX_TEXTURES] = {u.a, u.b, u.c};
    uint variant = 0u;
    for (uint i = 0u; i < surface.texture_count; ++i) {
        const uint levels = scene->textures[surface.textures[i]].levels;
        variant =
            variant * levels +
            texture_level(texture_here(scene, surface.textures[i], hit).value, levels, random[i]);
    }
    if (surface.normal_texture != NO_INDEX) {
        const TexturePoint point = texture_here(scene, surface.normal_texture, hit);
        const Vec3 tilted = tilted_normal(*normal, point.slope_x, point.slope_y);
        if (vec3_dot(tilted, to_camera) > 0.0f)
            *normal = tilted;
    }
    return surface.first_material + variant;
}
#endif

/// The frame stands on the shading normal, or on the geometric one where the shading normal faces
/// away from the camera.
static SurfacePoint surface_point(const ShadeScene* scene, const ShadeStep* step) {
    const HitRecord hit = step->hit;
    const Vec3 to_camera = vec3_scale(ray_direction(step->ray), -1.0f);
    SurfacePoint point;
    point.geometric = hit_normal(hit);
    Vec3 shading = vec3(hit.shading_x, hit.shading_y, hit.shading_z);
    if (vec3_dot(point.geometric, to_camera) < 0.0f) {
        point.geometric = vec3_scale(point.geometric, -1.0f);
        shading = vec3_scale(shading, -1.0f);
    }
    shading = vec3_dot(shading, to_camera) > 0.0f ? shading : point.geometric;
    point.material = hit.material;
    point.is_sheet = 0;
#if FEATURE_TEXTURES
    const Random4 u = random_4(step->state.pixel, step->state.sample,
                               TEXTURE_DIMENSION + step->depth, scene->render.seed);
    point.material = choose_material(scene, hit, u, to_camera, &shading);
#endif
#if FEATURE_SHEETS
    const uint other_side = scene->materials[point.material].other_side;
    point.is_sheet = other_side != NO_INDEX;
    if (point.is_sheet && vec3_dot(hit_normal(hit), to_camera) < 0.0f)
        point.material = other_side;
#endif
    point.frame = sampling_frame(shading);
    point.wo = sampling_to_local(point.frame, to_camera);
    return point;
}

/// Returns true when a direction, `wi` in the local frame, leaves the surface on the side that the
/// path came from, or a sheet on either side.
int surface_is_left(SurfacePoint point, Vec3 wi, Vec3 direction) {
#if FEATURE_SHEETS
    if (point.is_sheet && wi.z < 0.0f)
        return vec3_dot(point.geometric, direction) < 0.0f;
#endif
    return wi.z > 0.0f && vec3_dot(point.geometric, direction) > 0.0f;
}

#endif
