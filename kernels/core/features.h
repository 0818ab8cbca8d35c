// Kernels are specialised by these: the feature bits, what follows from them, and sizes. The host
// derives them from the scene (host/render/plan/render_plan.h) and passes each as -D NAME=VALUE;
// the defaults let every file of the kernels compile alone with everything on. A bit that is off
// removes code, tables, buffers and launches. Structure by define, numbers by argument.
#ifndef RERADIANT_FEATURES_H
#define RERADIANT_FEATURES_H

// Functions that pass float16 where registers are narrower: the warning is about callers built with
// other settings, and a program is always built whole.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wpsabi"
#endif

#include "kernels/core/feature_bits.h"

/// Wavelengths that a path carries when they are sampled from a hero; 0: all lanes (comb).
#ifndef HERO
#define HERO 0
#endif
#define FEATURE_HERO (HERO > 0)

/// Vectors of WIDTH wavelengths; CHUNKS of them make a path's lanes.
#ifndef CHUNKS
#define CHUNKS 4
#endif
#define WIDTH 16
#define LANES (CHUNKS * WIDTH)
/// Vectors of a film pixel: CHUNKS, or what the bands need with FEATURE_SCATTER.
#ifndef FILM_CHUNKS
#define FILM_CHUNKS CHUNKS
#endif
#define FILM_LANES (FILM_CHUNKS * WIDTH)
/// Deeper rough lobes of the material that has most.
#ifndef LOBES
#define LOBES 2
#endif
/// Channels of the material with dyes that has most.
#ifndef DYE_CHANNELS
#define DYE_CHANNELS 2
#endif
/// Layers of the material with most that is walked through.
#ifndef WALK_LAYERS
#define WALK_LAYERS 2
#endif

#define FEATURE_LIGHT_SAMPLING                                                                     \
    (FEATURE_AREA_LIGHTS || FEATURE_DELTA_LIGHTS || FEATURE_SPOT_LIGHTS ||                         \
     FEATURE_DISTANT_LIGHTS || FEATURE_ENVIRONMENT_IMAGE)
/// Some lights are both looked for and met by chance.
#define FEATURE_LIGHTS_MET                                                                         \
    (FEATURE_AREA_LIGHTS || FEATURE_DISTANT_LIGHTS || FEATURE_ENVIRONMENT_IMAGE)
/// Vertices keep colours that images gave.
#define FEATURE_COLOURS (FEATURE_ENVIRONMENT_IMAGE || FEATURE_REFLECTANCE_IMAGE)
/// Model A's interfaces act lane by lane.
#define FEATURE_MODEL_A_PER_LANE (FEATURE_DISPERSION && FEATURE_WEIDLICH_WILKIE)
/// Deeper lobes of model A have factors in the tables.
#define FEATURE_MODEL_A_TABULATED                                                                  \
    (FEATURE_DEEPER_LOBES && FEATURE_WEIDLICH_WILKIE &&                                            \
     (FEATURE_SCATTERING_SLABS || FEATURE_TABULATED_REFLECTANCE))

#endif
