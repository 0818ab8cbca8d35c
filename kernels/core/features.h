// The feature bits. The host derives them from the scene and passes each as -D NAME=0|1; the
// defaults here let every file of the kernels compile alone with everything on. A bit that is off
// removes code, tables, buffers and launches. Structure by define, numbers by argument.
#ifndef RERADIANT_FEATURES_H
#define RERADIANT_FEATURES_H

// Functions that pass float16 where registers are narrower: the warning is about callers built with
// other settings, and a program is always built whole.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wpsabi"
#endif

/// Some substrate re-radiates (factored or dense).
#ifndef FEATURE_FLUORESCENCE
#define FEATURE_FLUORESCENCE 1
#endif
/// Some re-radiation matrix does not factor to RANK terms and is applied densely.
#ifndef FEATURE_DENSE_MATRIX
#define FEATURE_DENSE_MATRIX 1
#endif
/// Some stack's tables depend on wavelength (absorption or dispersion).
#ifndef FEATURE_SPECTRAL_STACK
#define FEATURE_SPECTRAL_STACK 1
#endif
/// Fresnel factors that kernels evaluate (rough top, or model A) depend on wavelength.
#ifndef FEATURE_DISPERSION
#define FEATURE_DISPERSION 1
#endif
/// Some material has a mirror delta (smooth interfaces, metals, flakes).
#ifndef FEATURE_SMOOTH
#define FEATURE_SMOOTH 1
#endif
/// Some material has a rough top interface, or is a bare rough metal.
#ifndef FEATURE_ROUGH
#define FEATURE_ROUGH 1
#endif
/// Some material has lobes of deeper interfaces, metals, flakes or slabs.
#ifndef FEATURE_DEEPER_LOBES
#define FEATURE_DEEPER_LOBES 1
#endif
/// Some material with lobes uses the model of Weidlich and Wilkie.
#ifndef FEATURE_WEIDLICH_WILKIE
#define FEATURE_WEIDLICH_WILKIE 1
#endif
/// Some reflectance at facets is tabulated per lane: conductors, flakes, films.
#ifndef FEATURE_TABULATED_REFLECTANCE
#define FEATURE_TABULATED_REFLECTANCE 1
#endif
/// Some slab scatters.
#ifndef FEATURE_SCATTERING_SLABS
#define FEATURE_SCATTERING_SLABS 1
#endif
/// Some substrate is Oren-Nayar.
#ifndef FEATURE_OREN_NAYAR
#define FEATURE_OREN_NAYAR 1
#endif
/// Some material is rendered by the random walk through its stack.
#ifndef FEATURE_WALK
#define FEATURE_WALK 1
#endif
/// Rectangle or sphere lights.
#ifndef FEATURE_AREA_LIGHTS
#define FEATURE_AREA_LIGHTS 1
#endif
/// Point or directional lights.
#ifndef FEATURE_DELTA_LIGHTS
#define FEATURE_DELTA_LIGHTS 1
#endif
/// A constant environment.
#ifndef FEATURE_ENVIRONMENT
#define FEATURE_ENVIRONMENT 1
#endif
/// The environment is an image.
#ifndef FEATURE_ENVIRONMENT_IMAGE
#define FEATURE_ENVIRONMENT_IMAGE 1
#endif
/// Some surface has textures, a perturbed normal, or is a mixture.
#ifndef FEATURE_TEXTURES
#define FEATURE_TEXTURES 1
#endif
/// Some substrate's reflectance is coloured by an image.
#ifndef FEATURE_REFLECTANCE_IMAGE
#define FEATURE_REFLECTANCE_IMAGE 1
#endif
/// A lens of finite radius.
#ifndef FEATURE_LENS
#define FEATURE_LENS 1
#endif

/// Film sums are kept per band, each lane added to the band its wavelength falls into; without
/// it they are kept per lane, every lane belonging to one band for all phases.
#ifndef FEATURE_SCATTER
#define FEATURE_SCATTER 1
#endif
/// Film keeps sums of squares per band (needs FEATURE_SCATTER).
#ifndef FEATURE_BAND_VARIANCE
#define FEATURE_BAND_VARIANCE 1
#endif

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
/// Layers of the material with most that is walked through.
#ifndef WALK_LAYERS
#define WALK_LAYERS 2
#endif

#define FEATURE_LIGHT_SAMPLING                                                                     \
    (FEATURE_AREA_LIGHTS || FEATURE_DELTA_LIGHTS || FEATURE_ENVIRONMENT_IMAGE)
/// Vertices keep colours that images gave.
#define FEATURE_COLOURS (FEATURE_ENVIRONMENT_IMAGE || FEATURE_REFLECTANCE_IMAGE)

#endif
