// Wavelength sampling `comb`: every path carries all lanes; the phase, one of `phases` equal
// sub-cells of a comb cell, is stratified over a pixel's samples.
#ifndef RERADIANT_WAVELENGTH_H
#define RERADIANT_WAVELENGTH_H

#include "kernels/portable.h"
#include "kernels/random.h"

KERNELS_BEGIN

/// Phase of a sample. Samples 2k and 2k+1 share it, so that the two halves of a pixel's samples,
/// whose difference estimates the error, see the same phases; the order starts anywhere.
/// An odd stride visits every phase because `phases` is a power of two.
DEVICE_FUNCTION uint wavelength_phase(uint pixel, uint sample, uint phases, uint seed) {
    const uint start = random_hash(pixel, seed);
    return (start + (sample >> 1) * 5u) & (phases - 1u);
}

KERNELS_END

#endif
