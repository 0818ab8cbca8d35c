// Defines what the functions that `reradiant check` calls read besides their arguments: the records
// and tables of one small scene.
#ifndef RERADIANT_CHECK_TABLES_H
#define RERADIANT_CHECK_TABLES_H

#include "kernels/core/features.h"
#include "kernels/core/shared.h"
#include "kernels/scatter/lobe_ratio.h"

/// Three of a checked function's arguments, or of its results, as a vector.
#define CHECK_VECTOR(k) vec3(in[k], in[(k) + 1], in[(k) + 2])
#define CHECK_RESULT(k, v) out[k] = (v).x, out[(k) + 1] = (v).y, out[(k) + 2] = (v).z

/// The tables' material, and a surface of Smith's kind by two arguments' distribution, alpha, IOR.
#define CHECK_STACK                                                                                \
    { tables->material, tables->layers, tables->lobes, tables->choice }
/// Makes a view of it that of a sheet with rough faces, whose ratio lies behind the choices and the
/// shape.
#define AS_SHEET(stack)                                                                            \
    stack.record.other_side = 0u, stack.record.through_first = 1u,                                 \
    stack.record.through_width = 0.2f,                                                             \
    stack.record.through_ratio = TABLE_NODES * CHECK_CHOICES + SHAPE_TABLE_SIZE
#define CHECK_SURFACE                                                                              \
    { (int)in[0] + MICROFACET_BECKMANN, in[1], in[2], 1, 0, 0 }

/// Columns of a row of choices (layer_stack.h).
#define CHECK_CHOICES (4 + LOBES + 3 * FEATURE_SHEETS)
#define CHECK_LAYERS 3
#define CHECK_TEXTURES 4
#define CHECK_LIGHTS 4
/// A disk, a mesh of two triangles, a spot, a distant light.
#define CHECK_LAMPS 4
#define CHECK_RANK 2
#define CHECK_IMAGE_WIDTH 16
#define CHECK_IMAGE_HEIGHT 8
#define CHECK_IMAGE_TEXELS (CHECK_IMAGE_WIDTH * CHECK_IMAGE_HEIGHT)

#ifndef __OPENCL_VERSION__
namespace reradiant {
#endif

typedef struct {
    MaterialRecord material;
    LayerRecord layers[CHECK_LAYERS];
    LobeRecord lobes[LOBES];
    TextureRecord textures[CHECK_TEXTURES];
    LightRecord lights[CHECK_LIGHTS];
    LightRecord lamps[CHECK_LAMPS]; ///< offsets into `triangles`
    shared_float triangles[2 * 10];
    CameraRecord camera;
    EnvironmentRecord environment; ///< offsets into `image`
    shared_float choice[TABLE_NODES * CHECK_CHOICES];
    shared_float shape[SHAPE_TABLE_SIZE];
    shared_float ratio[LOBE_RATIO_SIZE];
    shared_float image[5 * CHECK_IMAGE_TEXELS + CHECK_IMAGE_HEIGHT];
    shared_float factors[2 * CHECK_RANK * LANES];
    shared_float dense[LANES * LANES];
    shared_float shift[LANES * LANES]; ///< cumulative along rows
} CheckTables;

#ifndef __OPENCL_VERSION__
} // namespace reradiant
#endif

#endif
