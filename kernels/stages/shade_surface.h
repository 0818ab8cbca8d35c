// Defines what `shade` reads of the scene, and finds the point of a surface that a path has met.
#ifndef RERADIANT_SHADE_SURFACE_H
#define RERADIANT_SHADE_SURFACE_H

#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/random.h"
#include "kernels/core/sampling.h"
#include "kernels/core/shared.h"
#include "kernels/scene/texture.h"

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
    EnvironmentRecord image; ///< the environment where it is an image
    uint light_count;
    uint environment; ///< light of a constant environment, or NO_INDEX
} ShadeScene;

/// Origin moved off the surface to the side of `direction`, beyond the position's error bound
/// (after Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., section 6.8.6).
Vec3 offset_origin(HitRecord hit, Vec3 direction) {
    const Vec3 n = vec3(hit.normal_x, hit.normal_y, hit.normal_z);
    const real reach = 2.0f * hit.position_error * (fabs(n.x) + fabs(n.y) + fabs(n.z));
    const real side = vec3_dot(n, direction) < 0.0f ? -reach : reach;
    return vec3_add(vec3(hit.position_x, hit.position_y, hit.position_z), vec3_scale(n, side));
}

RayRecord ray_record(Vec3 origin, Vec3 direction, real t_far) {
    RayRecord ray;
    ray.origin_x = origin.x;
    ray.origin_y = origin.y;
    ray.origin_z = origin.z;
    ray.t_near = 0.0f;
    ray.direction_x = direction.x;
    ray.direction_y = direction.y;
    ray.direction_z = direction.z;
    ray.t_far = t_far;
    return ray;
}

/// A `SurfacePoint` is the point at which a path meets a material, with a local frame on the side
/// that the ray came from.
typedef struct {
    HitRecord hit;
    Frame frame;
    Vec3 geometric; ///< normal on the side of the camera
    Vec3 wo;        ///< towards the camera, local
    uint material;
} SurfacePoint;

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

TexturePoint texture_here(const ShadeScene* scene, uint texture, HitRecord hit) {
    return texture_at(scene->textures[texture],
                      vec3(hit.position_x, hit.position_y, hit.position_z), hit.u, hit.v,
                      scene->tables);
}

/// The material of a surface at a point, one level of each texture picked by u.a, u.b, u.c, a
/// mixture's side by u.d; *normal is tilted where the surface says so.
uint choose_material(const ShadeScene* scene, HitRecord hit, Random4 u, Vec3 to_camera,
                     Vec3* normal) {
    SurfaceRecord surface = scene->surfaces[hit.material];
    if (surface.mixed_with != NO_INDEX) {
        const real weight = surface.mix_texture == NO_INDEX
                                ? surface.mix_weight
                                : texture_here(scene, surface.mix_texture, hit).value;
        if (u.d < weight)
            surface = scene->surfaces[surface.mixed_with];
    }
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
SurfacePoint surface_point(const ShadeScene* scene, HitRecord hit, RayRecord ray, Random4 u) {
    const Vec3 to_camera = vec3(-ray.direction_x, -ray.direction_y, -ray.direction_z);
    SurfacePoint point;
    point.hit = hit;
    point.geometric = vec3(hit.normal_x, hit.normal_y, hit.normal_z);
    Vec3 shading = vec3(hit.shading_x, hit.shading_y, hit.shading_z);
    if (vec3_dot(point.geometric, to_camera) < 0.0f) {
        point.geometric = vec3_scale(point.geometric, -1.0f);
        shading = vec3_scale(shading, -1.0f);
    }
    shading = vec3_dot(shading, to_camera) > 0.0f ? shading : point.geometric;
    point.material = hit.material;
#if FEATURE_TEXTURES
    point.material = choose_material(scene, hit, u, to_camera, &shading);
#endif
    point.frame = sampling_frame(shading);
    point.wo = sampling_to_local(point.frame, to_camera);
    return point;
}

VertexRecord empty_vertex(void) {
    const DirectionRecord nothing = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    VertexRecord vertex = {NO_INDEX, NO_INDEX, 0.0f, NO_INDEX, 0.0f,
                           0.0f,     1.0f,     0u,   nothing,  nothing};
    return vertex;
}

#endif
