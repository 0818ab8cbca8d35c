// Counter-based random numbers: a number depends only on (pixel, sample, dimension, seed), so an
// image does not depend on threads, batches or on how samples are spread over machines.
#ifndef RERADIANT_RANDOM_H
#define RERADIANT_RANDOM_H

#include "kernels/core/portable.h"

KERNELS_BEGIN

typedef struct {
    real a, b, c, d;
} Random4;

/// 24 bits to [0, 1): never 1, also in single precision (uint * 2^-32 can round up to 1).
DEVICE_FUNCTION real random_unit(uint bits) {
    return (real)(bits >> 8) * REAL(5.9604644775390625e-8);
}

// The two hashes below are written once for one number and for a vector of them, one of each path
// (kernels/core/sequence.h).

/// Four words hashed from four: PCG4D, Jarzynski and Olano, "Hash Functions for GPU Rendering",
/// JCGT 9(3), 2020, listing of pcg4d.
#define RANDOM_WORDS_FUNCTION(name, Block, Word)                                                   \
    DEVICE_FUNCTION Block name(Word a, Word b, uint c, uint d) {                                   \
        Block r;                                                                                   \
        r.x = a * 1664525u + 1013904223u;                                                          \
        r.y = b * 1664525u + 1013904223u;                                                          \
        r.z = (Word)(c * 1664525u + 1013904223u);                                                  \
        r.w = (Word)(d * 1664525u + 1013904223u);                                                  \
        r.x += r.y * r.w;                                                                          \
        r.y += r.z * r.x;                                                                          \
        r.z += r.x * r.y;                                                                          \
        r.w += r.y * r.z;                                                                          \
        r.x ^= r.x >> 16;                                                                          \
        r.y ^= r.y >> 16;                                                                          \
        r.z ^= r.z >> 16;                                                                          \
        r.w ^= r.w >> 16;                                                                          \
        r.x += r.y * r.w;                                                                          \
        r.y += r.z * r.x;                                                                          \
        r.z += r.x * r.y;                                                                          \
        r.w += r.y * r.z;                                                                          \
        return r;                                                                                  \
    }

/// A word that depends on a pixel and the seed alone.
#define RANDOM_HASH_FUNCTION(name, Word)                                                           \
    DEVICE_FUNCTION Word name(Word pixel, uint seed) {                                             \
        const Word state = (pixel ^ (seed * 2654435769u)) * 747796405u + 2891336453u;              \
        const Word word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;                  \
        return (word >> 22) ^ word;                                                                \
    }

typedef struct {
    uint x, y, z, w;
} RandomWords;

RANDOM_WORDS_FUNCTION(random_words, RandomWords, uint)
RANDOM_HASH_FUNCTION(random_hash, uint)

/// Four independent numbers in [0, 1) for one dimension block.
DEVICE_FUNCTION Random4 random_4(uint pixel, uint sample, uint dimension, uint seed) {
    const RandomWords words = random_words(pixel, sample, dimension, seed);
    Random4 r;
    r.a = random_unit(words.x);
    r.b = random_unit(words.y);
    r.c = random_unit(words.z);
    r.d = random_unit(words.w);
    return r;
}

KERNELS_END

#endif
