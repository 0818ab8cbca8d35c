// The feature bits, each once: what it stands for, with FEATURE_BIT(name, why_off) defined its
// entry in the list of all bits, and else what it is where nobody says: on, so that every file
// compiles alone with everything. This file may be included again and again.

/// Some substrate re-radiates (factored or dense).
#ifdef FEATURE_BIT
FEATURE_BIT(fluorescence, "no substrate re-radiates")
#elif !defined(FEATURE_FLUORESCENCE)
#define FEATURE_FLUORESCENCE 1
#endif

/// Some re-radiation matrix does not factor to RANK terms and is applied densely.
#ifdef FEATURE_BIT
FEATURE_BIT(dense_matrix, "every re-radiation matrix factors")
#elif !defined(FEATURE_DENSE_MATRIX)
#define FEATURE_DENSE_MATRIX 1
#endif

/// Some stack's tables depend on wavelength (absorption or dispersion).
#ifdef FEATURE_BIT
FEATURE_BIT(spectral_stack, "no layer absorbs or disperses")
#elif !defined(FEATURE_SPECTRAL_STACK)
#define FEATURE_SPECTRAL_STACK 1
#endif

/// Fresnel factors that kernels evaluate (rough top, or model A) depend on wavelength.
#ifdef FEATURE_BIT
FEATURE_BIT(dispersion,
            "no rough interface that kernels evaluate has an IOR that depends on wavelength")
#elif !defined(FEATURE_DISPERSION)
#define FEATURE_DISPERSION 1
#endif

/// Some material has a mirror delta (smooth interfaces, metals, flakes).
#ifdef FEATURE_BIT
FEATURE_BIT(smooth, "nothing smooth reflects")
#elif !defined(FEATURE_SMOOTH)
#define FEATURE_SMOOTH 1
#endif

/// Some material has a rough top interface, or is a bare rough metal.
#ifdef FEATURE_BIT
FEATURE_BIT(rough, "no top interface or bare metal is rough")
#elif !defined(FEATURE_ROUGH)
#define FEATURE_ROUGH 1
#endif

/// Some material has lobes of deeper interfaces, metals, flakes or slabs.
#ifdef FEATURE_BIT
FEATURE_BIT(deeper_lobes, "nothing under a top interface makes a highlight of its own")
#elif !defined(FEATURE_DEEPER_LOBES)
#define FEATURE_DEEPER_LOBES 1
#endif

/// Some material with lobes uses the model of Weidlich and Wilkie.
#ifdef FEATURE_BIT
FEATURE_BIT(weidlich_wilkie,
            "no stack with highlights of its own below the top uses the model weidlich-wilkie")
#elif !defined(FEATURE_WEIDLICH_WILKIE)
#define FEATURE_WEIDLICH_WILKIE 1
#endif

/// Some reflectance at facets is tabulated per lane: conductors, flakes, films.
#ifdef FEATURE_BIT
FEATURE_BIT(tabulated_reflectance, "no rough metal, flakes or film")
#elif !defined(FEATURE_TABULATED_REFLECTANCE)
#define FEATURE_TABULATED_REFLECTANCE 1
#endif

/// Some slab scatters.
#ifdef FEATURE_BIT
FEATURE_BIT(scattering_slabs, "no slab scatters")
#elif !defined(FEATURE_SCATTERING_SLABS)
#define FEATURE_SCATTERING_SLABS 1
#endif

/// Some slab holds a dye, and its material is no walk's.
#ifdef FEATURE_BIT
FEATURE_BIT(dyes, "no slab holds a dye")
#elif !defined(FEATURE_DYES)
#define FEATURE_DYES 1
#endif

/// Some material is a sheet that light goes through.
#ifdef FEATURE_BIT
FEATURE_BIT(sheets, "light goes through no material")
#elif !defined(FEATURE_SHEETS)
#define FEATURE_SHEETS 1
#endif

/// Some slab holds a dye, and its material is walked through (needs FEATURE_SCATTERING_SLABS).
#ifdef FEATURE_BIT
FEATURE_BIT(walked_dyes, "no slab that is walked through holds a dye")
#elif !defined(FEATURE_WALKED_DYES)
#define FEATURE_WALKED_DYES 1
#endif

/// Lights are looked for through smooth sheets.
#ifdef FEATURE_BIT
FEATURE_BIT(passed_sheets, "no light is looked for through a smooth sheet")
#elif !defined(FEATURE_PASSED_SHEETS)
#define FEATURE_PASSED_SHEETS 1
#endif

/// Some substrate is Oren-Nayar.
#ifdef FEATURE_BIT
FEATURE_BIT(oren_nayar, "no substrate is Oren-Nayar")
#elif !defined(FEATURE_OREN_NAYAR)
#define FEATURE_OREN_NAYAR 1
#endif

/// Some material is rendered by the random walk through its stack.
#ifdef FEATURE_BIT
FEATURE_BIT(walk, "no material uses the model walk")
#elif !defined(FEATURE_WALK)
#define FEATURE_WALK 1
#endif

/// Lights with a surface.
#ifdef FEATURE_BIT
FEATURE_BIT(area_lights, "no light has a surface")
#elif !defined(FEATURE_AREA_LIGHTS)
#define FEATURE_AREA_LIGHTS 1
#endif

/// Point or directional lights.
#ifdef FEATURE_BIT
FEATURE_BIT(delta_lights, "no point or directional light")
#elif !defined(FEATURE_DELTA_LIGHTS)
#define FEATURE_DELTA_LIGHTS 1
#endif

/// Disk or mesh lights (needs FEATURE_AREA_LIGHTS).
#ifdef FEATURE_BIT
FEATURE_BIT(shaped_lights, "no disk or mesh light")
#elif !defined(FEATURE_SHAPED_LIGHTS)
#define FEATURE_SHAPED_LIGHTS 1
#endif

/// Spot lights.
#ifdef FEATURE_BIT
FEATURE_BIT(spot_lights, "no spot light")
#elif !defined(FEATURE_SPOT_LIGHTS)
#define FEATURE_SPOT_LIGHTS 1
#endif

/// Directional lights that fill a cone of directions, such as the sun.
#ifdef FEATURE_BIT
FEATURE_BIT(distant_lights, "no sun, and no other directional light with an angle")
#elif !defined(FEATURE_DISTANT_LIGHTS)
#define FEATURE_DISTANT_LIGHTS 1
#endif

/// A constant environment.
#ifdef FEATURE_BIT
FEATURE_BIT(environment, "no environment light of one radiance all around")
#elif !defined(FEATURE_ENVIRONMENT)
#define FEATURE_ENVIRONMENT 1
#endif

/// The environment is an image.
#ifdef FEATURE_BIT
FEATURE_BIT(environment_image, "no environment is an image")
#elif !defined(FEATURE_ENVIRONMENT_IMAGE)
#define FEATURE_ENVIRONMENT_IMAGE 1
#endif

/// Some surface has textures, a perturbed normal, or is a mixture.
#ifdef FEATURE_BIT
FEATURE_BIT(textures, "no material has textures or is a mixture")
#elif !defined(FEATURE_TEXTURES)
#define FEATURE_TEXTURES 1
#endif

/// Some mixture's other material is a mixture (needs FEATURE_TEXTURES).
#ifdef FEATURE_BIT
FEATURE_BIT(nested_mixtures, "no mixture is mixed into another")
#elif !defined(FEATURE_NESTED_MIXTURES)
#define FEATURE_NESTED_MIXTURES 1
#endif

/// Some substrate's reflectance is coloured by an image.
#ifdef FEATURE_BIT
FEATURE_BIT(reflectance_image, "no reflectance is an image")
#elif !defined(FEATURE_REFLECTANCE_IMAGE)
#define FEATURE_REFLECTANCE_IMAGE 1
#endif

/// A lens of finite radius.
#ifdef FEATURE_BIT
FEATURE_BIT(lens, "the camera is a pinhole")
#elif !defined(FEATURE_LENS)
#define FEATURE_LENS 1
#endif

/// Film sums are kept per band, each lane added to the band its wavelength falls into; without
/// it they are kept per lane, every lane belonging to one band for all phases.
#ifdef FEATURE_BIT
FEATURE_BIT(scatter, "every wavelength belongs to one film band")
#elif !defined(FEATURE_SCATTER)
#define FEATURE_SCATTER 1
#endif

/// Film keeps sums of squares per band (needs FEATURE_SCATTER).
#ifdef FEATURE_BIT
FEATURE_BIT(band_variance, "variance per band was not asked for")
#elif !defined(FEATURE_BAND_VARIANCE)
#define FEATURE_BAND_VARIANCE 1
#endif
