// The arguments of each kernel, once: the signature and the host's call (host/render/wavefront) are
// both made of these lists. INPUT and OUTPUT stand for an array, by the type of its elements and
// the name that it has among the buffers of a render (host/render/plan/buffer_plan.h), STRIP for
// one of a strip of the film, VALUE for a record that goes by value.
#ifndef RERADIANT_ARGUMENTS_H
#define RERADIANT_ARGUMENTS_H

#include "kernels/core/shared.h"

#define GENERATE_ARGUMENTS(INPUT, OUTPUT, STRIP, VALUE)                                            \
    OUTPUT(RayRecord, rays), OUTPUT(PathState, paths), INPUT(PixelSamples, chosen),                \
        VALUE(RenderRecord, render), VALUE(BatchRecord, batch)

#define SHADE_ARGUMENTS(INPUT, OUTPUT, STRIP, VALUE)                                               \
    OUTPUT(RayRecord, rays), INPUT(HitRecord, hits), OUTPUT(PathState, paths),                     \
        OUTPUT(VertexRecord, vertices), OUTPUT(RayRecord, shadow_rays),                            \
        OUTPUT(shared_float, lobe_weights), OUTPUT(shared_float, colours),                         \
        INPUT(MaterialRecord, materials), INPUT(LayerRecord, layers), INPUT(LobeRecord, lobes),    \
        INPUT(SurfaceRecord, surfaces), INPUT(TextureRecord, textures),                            \
        INPUT(LightRecord, lights), INPUT(shared_float, tables),                                   \
        INPUT(WalkPartRecord, walk_parts), OUTPUT(WalkChunk, walk_chunks),                         \
        OUTPUT(shared_uint, walk_chunks_used), OUTPUT(WalkVertexRecord, walk_vertices),            \
        INPUT(shared_uint, live), OUTPUT(shared_byte, goes_on), VALUE(RenderRecord, render),       \
        VALUE(DepthRecord, now)

#define GATHER_ARGUMENTS(INPUT, OUTPUT, STRIP, VALUE)                                              \
    OUTPUT(shared_float, radiance), INPUT(PathState, paths), INPUT(VertexRecord, vertices),        \
        INPUT(RayRecord, shadow_rays), INPUT(SheetCrossing, crossings),                            \
        INPUT(shared_float, lobe_weights), INPUT(shared_float, colours),                           \
        INPUT(MaterialRecord, materials), INPUT(LayerRecord, layers), INPUT(LobeRecord, lobes),    \
        INPUT(LightRecord, lights), INPUT(shared_float, tables),                                   \
        INPUT(WalkPartRecord, walk_parts), INPUT(WalkChunk, walk_chunks),                          \
        INPUT(WalkVertexRecord, walk_vertices), OUTPUT(shared_uint, hero_lanes),                   \
        OUTPUT(shared_float, hero_weights), VALUE(RenderRecord, render), VALUE(BatchRecord, batch)

#define FILM_ARGUMENTS(INPUT, OUTPUT, STRIP, VALUE)                                                \
    STRIP(shared_float, sums), STRIP(shared_float, statistics), INPUT(shared_float, radiance),     \
        INPUT(PathState, paths), INPUT(shared_int, film_bands), INPUT(shared_float, film_weights), \
        INPUT(shared_float, y_weights), VALUE(BatchRecord, batch)

#ifdef __OPENCL_VERSION__
#define KERNEL_INPUT(type, name) __global const type* name
#define KERNEL_OUTPUT(type, name) __global type* name
#define KERNEL_VALUE(type, name) const type name
#define KERNEL_SIGNATURE(list) list(KERNEL_INPUT, KERNEL_OUTPUT, KERNEL_OUTPUT, KERNEL_VALUE)
#endif

#endif
