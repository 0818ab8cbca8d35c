// How wide the lobe of a deep interface is, seen through the rough interfaces above it.
#ifndef RERADIANT_LOBE_WIDTH_H
#define RERADIANT_LOBE_WIDTH_H

#include "kernels/core/portable.h"
#include "kernels/scatter/microfacet.h"

KERNELS_BEGIN

/// Widths that lobes can have.
#define LOBE_WIDTH_LEAST REAL(0.0009765625)
#define LOBE_WIDTH_MOST REAL(1.0)

/// Component along the normal of a wave vector in a medium, over that of air; `sin2` is the square
/// of the sine in air, which Snell's law keeps.
DEVICE_FUNCTION real lobe_width_normal(real ior, real sin2) {
    return sqrt(fmax(square(ior) - sin2, REAL(0.0)));
}

/// What a passage through a rough interface spreads the wave vector along the surface by: a facet
/// of slope m changes it by m times the change of its component along the normal.
DEVICE_FUNCTION real lobe_width_passage(real alpha, real ior_above, real ior_below, real sin2) {
    return alpha * fabs(lobe_width_normal(ior_below, sin2) - lobe_width_normal(ior_above, sin2));
}

/// Spreads add up by these terms: by their squares, as variances do. Those of ggx have no variance:
/// two that are equal make one of 2.5 times the square, between what their tails (2) and their peak
/// (3) would have it.
DEVICE_FUNCTION real lobe_width_term(int distribution, real spread) {
    return distribution == MICROFACET_GGX ? spread * sqrt(spread) : square(spread);
}

/// Width of a lobe over the half vector in air for directions of cosines cos_i and cos_o, from the
/// sum of the terms of its spreads; to first order in the slopes.
DEVICE_FUNCTION real lobe_width(int distribution, real terms, real cos_i, real cos_o) {
    const real spread = distribution == MICROFACET_GGX
                            ? exp(REAL(0.66666666666666667) * log(fmax(terms, REAL(1e-30))))
                            : sqrt(terms);
    return fmin(fmax(spread / fmax(cos_i + cos_o, REAL(1e-6)), LOBE_WIDTH_LEAST), LOBE_WIDTH_MOST);
}

KERNELS_END

#endif
