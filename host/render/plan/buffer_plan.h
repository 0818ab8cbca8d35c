#pragma once

#include "kernels/core/shared.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace reradiant {

// The arrays of a render on its device, each once: BUFFER(type of an element, name). Kernels know
// them by the same names (kernels/stages/arguments.h).

// These hold the scene, as it stands in SceneTables.
#define SCENE_BUFFERS(BUFFER)                                                                      \
    BUFFER(MaterialRecord, materials)                                                              \
    BUFFER(LayerRecord, layers)                                                                    \
    BUFFER(LobeRecord, lobes)                                                                      \
    BUFFER(SurfaceRecord, surfaces)                                                                \
    BUFFER(TextureRecord, textures)                                                                \
    BUFFER(LightRecord, lights)                                                                    \
    BUFFER(WalkPartRecord, walk_parts)                                                             \
    BUFFER(shared_float, tables)

// These hold the film's layout.
#define LAYOUT_BUFFERS(BUFFER)                                                                     \
    BUFFER(shared_int, film_bands)                                                                 \
    BUFFER(shared_float, film_weights)                                                             \
    BUFFER(shared_float, y_weights)

// These keep the paths of a batch.
#define PATH_BUFFERS(BUFFER)                                                                       \
    /* [path]; live: [2][path], those that reach an even and an odd depth */                       \
    BUFFER(RayRecord, rays)                                                                        \
    BUFFER(HitRecord, hits)                                                                        \
    BUFFER(PathState, paths)                                                                       \
    BUFFER(shared_uint, live)                                                                      \
    BUFFER(shared_byte, goes_on)                                                                   \
    BUFFER(shared_float, radiance)                                                                 \
    /* [depth][path] */                                                                            \
    BUFFER(VertexRecord, vertices)                                                                 \
    BUFFER(RayRecord, shadow_rays)                                                                 \
    BUFFER(SheetCrossing, crossings)                                                               \
    BUFFER(shared_float, colours)                                                                  \
    BUFFER(shared_float, lobe_weights)                                                             \
    BUFFER(WalkVertexRecord, walk_vertices)                                                        \
    /* [depth][path][hero_width], one depth more */                                                \
    BUFFER(shared_uint, hero_lanes)                                                                \
    BUFFER(shared_float, hero_weights)                                                             \
    /* what walks have room for at first; a batch that needs more gets more */                     \
    BUFFER(WalkChunk, walk_chunks)                                                                 \
    BUFFER(shared_uint, walk_chunks_used)                                                          \
    /* the pixels of an adaptive pass */                                                           \
    BUFFER(PixelSamples, chosen)

#define RENDER_BUFFERS(BUFFER)                                                                     \
    SCENE_BUFFERS(BUFFER)                                                                          \
    LAYOUT_BUFFERS(BUFFER)                                                                         \
    PATH_BUFFERS(BUFFER)

// Those of light layers, each a buffer: the lights as the layer is lit by them.
#define LAYER_BUFFERS(BUFFER) BUFFER(LightRecord, layer_lights)

// Those of the film, which lie in strips (DeviceFilm): [pixel][row][lane] and
// [pixel][FILM_STATISTICS], of the image and of every layer.
#define FILM_BUFFERS(BUFFER)                                                                       \
    BUFFER(shared_float, sums)                                                                     \
    BUFFER(shared_float, statistics)

/// Elements of each buffer; 0 for those that a scene does not need.
struct BufferCounts {
#define BUFFER(type, name) std::uint64_t name = 0;
    RENDER_BUFFERS(BUFFER)
    LAYER_BUFFERS(BUFFER)
    FILM_BUFFERS(BUFFER)
#undef BUFFER
};

/// One buffer that a scene needs.
struct BufferPlan {
    const char* name;
    std::size_t element_bytes;
    std::uint64_t count;

    std::uint64_t bytes() const { return element_bytes * count; }
};

/// Returns the buffers that are needed at all.
inline std::vector<BufferPlan> needed_buffers(const BufferCounts& counts) {
    std::vector<BufferPlan> buffers;
#define BUFFER(type, name)                                                                         \
    if (counts.name > 0)                                                                           \
        buffers.push_back({#name, sizeof(type), counts.name});
    RENDER_BUFFERS(BUFFER)
    LAYER_BUFFERS(BUFFER)
    FILM_BUFFERS(BUFFER)
#undef BUFFER
    return buffers;
}

} // namespace reradiant
