// Low-discrepancy numbers of a pixel's samples: two pairs a dimension block, each an Owen-scrambled
// (0, 2)-sequence whose order is shuffled by the block (Burley, "Practical Hash-based Owen
// Scrambling", JCGT 9(4), 2020, sections 2 to 5). As with random_4 a number depends only on (pixel,
// sample, dimension, seed).
//
// Even and odd samples take the points of two sequences that are scrambled independently: the
// difference of a pixel's two halves then estimates its error as it does for independent samples.
#ifndef RERADIANT_SEQUENCE_H
#define RERADIANT_SEQUENCE_H

#include "kernels/portable.h"
#include "kernels/random.h"

KERNELS_BEGIN

DEVICE_FUNCTION uint sequence_reversed(uint x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Owen's scrambling of a number whose bits are reversed: every bit is flipped by a hash of those
/// below it (Laine and Karras 2011 with the constants of Burley 2020, listing 1). The result has
/// its bits in order.
DEVICE_FUNCTION uint sequence_scrambled(uint reversed, uint seed) {
    uint x = reversed + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return sequence_reversed(x);
}

/// Second coordinate of Sobol's sequence, bits reversed: bit k is the parity of the bits j of the
/// index for which the binomial coefficient (j over k) is odd, which are those whose j holds k.
DEVICE_FUNCTION uint sequence_second_reversed(uint index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ ((index >> 16) & 0x0000ffffu);
}

/// Four numbers in [0, 1) for one dimension block: (b, c) and (a, d) are points of (0, 2)-sequences
/// whose prefixes of 2^k points are shuffled among themselves.
DEVICE_FUNCTION Random4 sequence_4(uint pixel, uint sample, uint dimension, uint seed) {
    const RandomWords keys = random_words(pixel, 2u * dimension + (sample & 1u), 0x5e90e2ceu, seed);
    const uint index = sequence_reversed(sample >> 1);
    const uint first = sequence_scrambled(index, keys.x);
    const uint second = sequence_scrambled(index, keys.w);
    Random4 r;
    r.b = random_unit(sequence_scrambled(first, keys.y));
    r.c = random_unit(sequence_scrambled(sequence_second_reversed(first), keys.z));
    r.a = random_unit(sequence_scrambled(second, keys.x * 0x9e3779b9u + 1u));
    r.d = random_unit(
        sequence_scrambled(sequence_second_reversed(second), keys.y * 0x85ebca6bu + 1u));
    return r;
}

/// The numbers of a dimension block of a path: from the sequence in the first `sequence_blocks`,
/// else independent.
DEVICE_FUNCTION Random4 path_numbers(uint pixel, uint sample, uint dimension, uint sequence_blocks,
                                     uint seed) {
    return dimension < sequence_blocks ? sequence_4(pixel, sample, dimension, seed)
                                       : random_4(pixel, sample, dimension, seed);
}

KERNELS_END

#endif
