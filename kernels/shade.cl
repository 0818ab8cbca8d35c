// Stage 3: at each hit, record a vertex, sample one light and one direction. Only scalars here:
// directions, pdfs, weights. Wavelengths come in `gather`.
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/sequence.h"
#include "kernels/core/shared.h"
#include "kernels/stages/arguments.h"
#include "kernels/stages/shade_layers.h"
#include "kernels/stages/shade_lights.h"
#include "kernels/stages/shade_surface.h"
#include "kernels/stages/shade_walk.h"

/// The colour that an image gives the substrate's reflectance here is kept for `gather`.
static void keep_reflectance_colour(const ShadeScene* scene, MaterialRecord material,
                                    const ShadeStep* step) {
#if FEATURE_REFLECTANCE_IMAGE
    if (material.reflectance_image == NO_INDEX)
        return;
    const TexturePoint texel = texture_here(scene, material.reflectance_image, step->hit);
    step->colour[3] = texel.red;
    step->colour[4] = texel.green;
    step->colour[5] = texel.blue;
#endif
}

/// A path at a surface: a vertex, a shadow ray, a way to go on. `u` and `v` are its numbers.
static void shade_surface(const ShadeScene* scene, Random4 u, Random4 v, ShadeStep* step) {
    const SurfacePoint point = surface_point(scene, step);
    const MaterialRecord material = scene->materials[point.material];
    step->state.vertex_count = step->depth + 1u;
    step->vertex.material = point.material;
    step->vertex.out_x = point.wo.x;
    step->vertex.out_y = point.wo.y;
    step->vertex.out_z = point.wo.z;
    keep_reflectance_colour(scene, material, step);
#if FEATURE_WALK
    if (material.walk != NO_INDEX) {
        shade_walk(scene, point, material, u, v.d, step);
        return;
    }
#endif
    shade_layers(scene, point, u, v, step);
}

__kernel void shade(KERNEL_SIGNATURE(SHADE_ARGUMENTS)) {
    const uint first = (uint)get_global_id(0) * PATHS_TOGETHER;
    if (first >= now.live_paths)
        return;

    const ShadeScene scene = {.materials = materials,
                              .layers = layers,
                              .lobes = lobes,
                              .surfaces = surfaces,
                              .textures = textures,
                              .lights = lights,
                              .tables = tables,
                              .walk_parts = walk_parts,
                              .walk_chunks = walk_chunks,
                              .walk_chunks_used = walk_chunks_used,
                              .walk_room = now.walk_chunks,
                              .render = render};
    __global const uint* places = live + (now.depth & 1u) * render.capacity + first;
    const uint together = min(now.live_paths - first, (uint)PATHS_TOGETHER);
    Words pixel = 0u, sample = 0u;
    for (uint k = 0u; k < together; ++k) {
        OF_PATH(uint, pixel, k) = paths[places[k]].pixel;
        OF_PATH(uint, sample, k) = paths[places[k]].sample;
    }
    const uint block = 2u * now.depth + 1u;
    const NumberBlock u = path_numbers(pixel, sample, block, render.sequence_blocks, render.seed);
    const NumberBlock v =
        path_numbers(pixel, sample, block + 1u, render.sequence_blocks, render.seed);

    for (uint k = 0u; k < together; ++k) {
        const uint path = places[k];
        const size_t slot = (size_t)now.depth * render.capacity + path;
        ShadeStep step = shade_step(rays[path], hits[path], paths[path], now.depth);
        step.lobe_weights = lobe_weights + slot * (2u * LOBES);
        step.colour = colours;
#if FEATURE_COLOURS
        step.colour += slot * VERTEX_COLOURS;
#endif

        if (is_on_emitter(step.hit))
            end_on_emitter(&scene, &step);
        else if (now.depth < render.max_depth)
            shade_surface(&scene, numbers_of_path(&u, k), numbers_of_path(&v, k), &step);

        goes_on[first + k] = ray_is_active(step.next);
        if (ray_is_active(step.next))
            rays[path] = step.next;
        if (step.state.vertex_count > now.depth) {
            vertices[slot] = step.vertex;
            paths[path] = step.state;
        }
#if FEATURE_LIGHT_SAMPLING
        shadow_rays[slot] = step.shadow;
#endif
#if FEATURE_WALK
        walk_vertices[slot] = step.walk;
#endif
    }
}
