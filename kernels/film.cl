// Stage 6: adds a batch's paths to their pixels, one work-item a pixel, samples in order, so that
// the sums do not depend on how samples were batched. Sums are compensated (Kahan 1965): a plain
// float sum stops growing at 2^24 samples.
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/stages/arguments.h"

#define FILM_ROWS (3 + FEATURE_BAND_VARIANCE)

/// Bits of lanes that are NaN or infinite: comparisons and fmax hide them on some compilers.
int16 film_not_finite(float16 v) {
    return (as_int16(v) & (int16)(0x7f800000)) == (int16)(0x7f800000);
}

/// A path's radiance in film lanes; returns 0 when some lane is not finite. bands: [LANES], where a
/// lane goes; weights: [LANES][2], its weight there and in the band above.
int film_read(__global const float* path, __global const int* bands, __global const float* weights,
              float16* value) {
    int16 bad = (int16)(0);
#if FEATURE_SCATTER
    for (uint c = 0u; c < FILM_CHUNKS; ++c)
        value[c] = (float16)(0.0f);
    for (uint lane = 0u; lane < LANES; ++lane)
        if (bands[lane] >= 0) {
            ((float*)value)[bands[lane]] += path[lane] * weights[2u * lane];
            if (weights[2u * lane + 1u] != 0.0f)
                ((float*)value)[bands[lane] + 1] += path[lane] * weights[2u * lane + 1u];
        }
    for (uint c = 0u; c < CHUNKS; ++c)
        bad |= film_not_finite(vload16(c, path));
#else
    for (uint c = 0u; c < CHUNKS; ++c) {
        value[c] = vload16(c, path);
        bad |= film_not_finite(value[c]);
    }
#endif
    return !any(bad);
}

/// Adds a value to a pixel's rows [FILM_ROWS][FILM_LANES]: sum, its compensation, alternating sum
/// (even minus odd samples), sum of squares.
void film_add(const float16* value, float sign, __global float* rows) {
    for (uint c = 0u; c < FILM_CHUNKS; ++c) {
        const float16 sum = vload16(c, rows);
        const float16 corrected = value[c] - vload16(c, rows + FILM_LANES);
        const float16 next = sum + corrected;
        vstore16((next - sum) - corrected, c, rows + FILM_LANES);
        vstore16(next, c, rows);
        vstore16(vload16(c, rows + 2 * FILM_LANES) + sign * value[c], c, rows + 2 * FILM_LANES);
#if FEATURE_BAND_VARIANCE
        vstore16(vload16(c, rows + 3 * FILM_LANES) + value[c] * value[c], c, rows + 3 * FILM_LANES);
#endif
    }
}

float film_luminance(const float16* value, __global const float* y_weights) {
    float16 y16 = (float16)(0.0f);
    for (uint c = 0u; c < FILM_CHUNKS; ++c)
        y16 += value[c] * vload16(c, y_weights);
    const float8 y8 = y16.lo + y16.hi;
    const float4 y4 = y8.lo + y8.hi;
    return (y4.x + y4.y) + (y4.z + y4.w);
}

/// These numbers are kept of a pixel besides its bands: sums of Y and of Y^2, their compensations,
/// samples refused, and (an integer) samples taken.
typedef struct {
    float2 y, y_compensation;
    float refused;
    uint taken;
} FilmStatistics;

FilmStatistics film_statistics(__global const float* from) {
    const FilmStatistics statistics = {vload2(0, from), vload2(1, from), from[4], as_uint(from[5])};
    return statistics;
}

void film_store_statistics(FilmStatistics statistics, __global float* to) {
    vstore2(statistics.y, 0, to);
    vstore2(statistics.y_compensation, 1, to);
    to[4] = statistics.refused;
    ((__global uint*)to)[5] = statistics.taken;
}

void film_add_luminance(float y, FilmStatistics* statistics) {
    const float2 corrected = (float2)(y, y * y) - statistics->y_compensation;
    const float2 next = statistics->y + corrected;
    statistics->y_compensation = (next - statistics->y) - corrected;
    statistics->y = next;
}

__kernel void film(KERNEL_SIGNATURE(FILM_ARGUMENTS)) {
    const uint pixel = (uint)get_global_id(0);
    if (pixel >= batch.pixels)
        return;
    const size_t first = (size_t)pixel * batch.samples;
    const size_t at = paths[first].pixel - batch.strip_pixel;
    __global float* rows = sums + at * (FILM_ROWS * FILM_LANES);
    FilmStatistics kept = film_statistics(statistics + at * FILM_STATISTICS);

    for (size_t path = first; path < first + batch.samples; ++path) {
        const uint lanes = paths[path].phase * LANES;
        float16 value[FILM_CHUNKS];
        ++kept.taken;
        if (!film_read(radiance + path * LANES, film_bands + lanes, film_weights + 2u * lanes,
                       value)) {
            kept.refused += 1.0f;
            continue;
        }
        film_add(value, (paths[path].sample & 1u) ? -1.0f : 1.0f, rows);
        film_add_luminance(film_luminance(value, y_weights), &kept);
    }

    film_store_statistics(kept, statistics + at * FILM_STATISTICS);
}
