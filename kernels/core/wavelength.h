// Wavelength sampling `comb`: every path carries all lanes; the phase, one of `phases` equal
// sub-cells of a comb cell, is stratified over a pixel's samples.
#ifndef RERADIANT_WAVELENGTH_H
#define RERADIANT_WAVELENGTH_H

#include "kernels/core/portable.h"
#include "kernels/core/random.h"
#include "kernels/core/sequence.h"

KERNELS_BEGIN

/// Phases of samples, `phases` a power of two up to 2^16: an Owen-scrambled radical inverse for the
/// even samples and another for the odd ones. The difference of these two halves, which estimates
/// the error, then knows of phases that were not seen yet.
DEVICE_FUNCTION Words wavelength_phases(Words pixel, Words sample, uint phases, uint seed) {
    const Words order = sequence_hash(2u * pixel + (sample & 1u), seed);
    const Words place = sequence_scrambled(sample >> 1, order); // the index is the reversed inverse
    return ((place >> 16) * phases) >> 16;
}

KERNELS_END

#endif
