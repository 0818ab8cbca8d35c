// Low-discrepancy numbers of a pixel's samples: two pairs a dimension block, each an Owen-scrambled
// (0, 2)-sequence whose order is shuffled by the block (Burley, "Practical Hash-based Owen
// Scrambling", JCGT 9(4), 2020, sections 2 to 5). As with random_4 a number depends only on (pixel,
// sample, dimension, seed).
//
// Even and odd samples take the points of two sequences that are scrambled independently: the
// difference of a pixel's two halves then estimates its error as it does for independent samples.
//
// A work-item takes the numbers of PATHS_TOGETHER paths at once where that is a device's way to
// vectors (host/render/wavefront). `Words` and `Reals` then hold one number of each path.
#ifndef RERADIANT_SEQUENCE_H
#define RERADIANT_SEQUENCE_H

#include "kernels/core/portable.h"
#include "kernels/core/random.h"

#ifndef PATHS_TOGETHER
#define PATHS_TOGETHER 1
#endif

KERNELS_BEGIN

#if PATHS_TOGETHER == 16
typedef uint16 Words;
#ifdef KERNELS_IN_DOUBLE
typedef double16 Reals;
#define SEQUENCE_REALS(words) convert_double16(words)
#else
typedef float16 Reals;
#define SEQUENCE_REALS(words) convert_float16(words)
#endif
typedef struct {
    Words x, y, z, w;
} WordBlock;
RANDOM_WORDS_FUNCTION(sequence_words, WordBlock, Words)
RANDOM_HASH_FUNCTION(sequence_hash, Words)
#else
typedef uint Words;
typedef real Reals;
typedef RandomWords WordBlock;
#define SEQUENCE_REALS(words) ((real)(words))
#define sequence_words random_words
#define sequence_hash random_hash
#endif

/// random_unit of each.
DEVICE_FUNCTION Reals sequence_unit(Words bits) {
    return SEQUENCE_REALS(bits >> 8) * REAL(5.9604644775390625e-8);
}

DEVICE_FUNCTION Words sequence_reversed(Words x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Owen's scrambling of a number whose bits are reversed: every bit is flipped by a hash of those
/// below it (Laine and Karras 2011 with the constants of Burley 2020, listing 1). The result has
/// its bits in order.
DEVICE_FUNCTION Words sequence_scrambled(Words reversed, Words seed) {
    Words x = reversed + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return sequence_reversed(x);
}

/// Second coordinate of Sobol's sequence, bits reversed: bit k is the parity of the bits j of the
/// index for which the binomial coefficient (j over k) is odd, which are those whose j holds k.
DEVICE_FUNCTION Words sequence_second_reversed(Words index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ ((index >> 16) & 0x0000ffffu);
}

/// Four numbers of each path.
typedef struct {
    Reals a, b, c, d;
} NumberBlock;

/// Numbers in [0, 1) of a dimension block: (b, c) and (a, d) are points of (0, 2)-sequences whose
/// prefixes of 2^k points are shuffled among themselves.
DEVICE_FUNCTION NumberBlock sequence_block(Words pixel, Words sample, uint dimension, uint seed) {
    const Words index = sequence_reversed(sample >> 1);
    const WordBlock hash = sequence_words(pixel, 2u * dimension + (sample & 1u), 0x5e90e2ceu, seed);
    const Words one = sequence_scrambled(index, hash.x), two = sequence_scrambled(index, hash.w);
    NumberBlock block;
    block.b = sequence_unit(sequence_scrambled(one, hash.y));
    block.c = sequence_unit(sequence_scrambled(sequence_second_reversed(one), hash.z));
    block.a = sequence_unit(sequence_scrambled(two, hash.x * 0x9e3779b9u + 1u));
    block.d =
        sequence_unit(sequence_scrambled(sequence_second_reversed(two), hash.y * 0x85ebca6bu + 1u));
    return block;
}

/// Numbers of a dimension block that are independent, as random_4 gives them.
DEVICE_FUNCTION NumberBlock independent_block(Words pixel, Words sample, uint dimension,
                                              uint seed) {
    const WordBlock words = sequence_words(pixel, sample, dimension, seed);
    NumberBlock block;
    block.a = sequence_unit(words.x);
    block.b = sequence_unit(words.y);
    block.c = sequence_unit(words.z);
    block.d = sequence_unit(words.w);
    return block;
}

/// Numbers of a dimension block of paths: of the sequence where the block is among the first
/// `sequence_blocks`, else independent.
DEVICE_FUNCTION NumberBlock path_numbers(Words pixel, Words sample, uint dimension,
                                         uint sequence_blocks, uint seed) {
    return dimension < sequence_blocks ? sequence_block(pixel, sample, dimension, seed)
                                       : independent_block(pixel, sample, dimension, seed);
}

/// The number of one of the paths among those of all, which are of `type` each.
#if PATHS_TOGETHER > 1
#define OF_PATH(type, all, path) (((type*)&(all))[path])
#else
#define OF_PATH(type, all, path) (*(&(all) + (path)))
#endif

DEVICE_FUNCTION Random4 numbers_of_path(const NumberBlock* block, uint path) {
    Random4 numbers;
    numbers.a = OF_PATH(const real, block->a, path);
    numbers.b = OF_PATH(const real, block->b, path);
    numbers.c = OF_PATH(const real, block->c, path);
    numbers.d = OF_PATH(const real, block->d, path);
    return numbers;
}

KERNELS_END

#endif
