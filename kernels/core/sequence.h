// Low-discrepancy numbers of a pixel's samples: two pairs a dimension block, each an Owen-scrambled
// (0, 2)-sequence whose order is shuffled by the block (Burley, "Practical Hash-based Owen
// Scrambling", JCGT 9(4), 2020, sections 2 to 5). As with random_4 a number depends only on (pixel,
// sample, dimension, seed).
//
// Even and odd samples take the points of two sequences that are scrambled independently: the
// difference of a pixel's two halves then estimates its error as it does for independent samples.
#ifndef RERADIANT_SEQUENCE_H
#define RERADIANT_SEQUENCE_H

#include "kernels/core/portable.h"
#include "kernels/core/random.h"

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

typedef struct {
    Random4 first, second;
} RandomBlocks;

/// Numbers in [0, 1) of a dimension block and of the next: in each (b, c) and (a, d) are points of
/// (0, 2)-sequences whose prefixes of 2^k points are shuffled among themselves. Eight coordinates
/// in one loop without branches become one of vectors.
DEVICE_FUNCTION RandomBlocks sequence_blocks_2(uint pixel, uint sample, uint dimension, uint seed) {
    const uint half_dimension = 2u * dimension + (sample & 1u);
    const uint index = sequence_reversed(sample >> 1);
    const RandomWords one = random_words(pixel, half_dimension, 0x5e90e2ceu, seed);
    const RandomWords two = random_words(pixel, half_dimension + 2u, 0x5e90e2ceu, seed);
    const uint shuffle[8] = {one.x, one.x, one.w, one.w, two.x, two.x, two.w, two.w};
    const uint scramble[8] = {one.y, one.z, one.x * 0x9e3779b9u + 1u, one.y * 0x85ebca6bu + 1u,
                              two.y, two.z, two.x * 0x9e3779b9u + 1u, two.y * 0x85ebca6bu + 1u};
    real numbers[8];
    for (uint k = 0u; k < 8u; ++k) {
        const uint shuffled = sequence_scrambled(index, shuffle[k]);
        const uint second = sequence_second_reversed(shuffled);
        numbers[k] =
            random_unit(sequence_scrambled((k & 1u) != 0u ? second : shuffled, scramble[k]));
    }
    RandomBlocks blocks;
    blocks.first.b = numbers[0];
    blocks.first.c = numbers[1];
    blocks.first.a = numbers[2];
    blocks.first.d = numbers[3];
    blocks.second.b = numbers[4];
    blocks.second.c = numbers[5];
    blocks.second.a = numbers[6];
    blocks.second.d = numbers[7];
    return blocks;
}

DEVICE_FUNCTION Random4 sequence_4(uint pixel, uint sample, uint dimension, uint seed) {
    return sequence_blocks_2(pixel, sample, dimension, seed).first;
}

/// The numbers of a dimension block of a path and of the next: from the sequence where both are
/// among the first `sequence_blocks`, else independent.
DEVICE_FUNCTION RandomBlocks path_numbers(uint pixel, uint sample, uint dimension,
                                          uint sequence_blocks, uint seed) {
    RandomBlocks blocks;
    if (dimension + 1u < sequence_blocks)
        return sequence_blocks_2(pixel, sample, dimension, seed);
    blocks.first = random_4(pixel, sample, dimension, seed);
    blocks.second = random_4(pixel, sample, dimension + 1u, seed);
    return blocks;
}

KERNELS_END

#endif
