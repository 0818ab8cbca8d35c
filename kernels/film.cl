// Stage 6: adds a batch's paths to their pixels, one work-item a pixel, samples in order, so that
// the sums do not depend on how samples were batched. Sums are compensated (Kahan 1965): a plain
// float sum stops growing at 2^24 samples.
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/shared.h"

#define FILM_ROWS (3 + FEATURE_BAND_VARIANCE)

/// Bits of lanes that are NaN or infinite: comparisons and fmax hide them on some compilers.
int16 film_not_finite(float16 v) {
    return (as_int16(v) & (int16)(0x7f800000)) == (int16)(0x7f800000);
}

/// A path's radiance in film lanes; returns 0 when some lane is not finite.
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

float film_luminance(const float16* value, __global const float* y_weights) {
    float16 y16 = (float16)(0.0f);
    for (uint c = 0u; c < FILM_CHUNKS; ++c)
        y16 += value[c] * vload16(c, y_weights);
    const float8 y8 = y16.lo + y16.hi;
    const float4 y4 = y8.lo + y8.hi;
    return (y4.x + y4.y) + (y4.z + y4.w);
}

/// sums: [pixel][FILM_ROWS][FILM_LANES]: sum, its compensation, alternating sum (even minus odd
/// samples), sum of squares. statistics: [pixel][6]: sums of Y and of Y^2, their compensations,
/// samples refused, and (an integer) samples taken, of the strip that begins with `first_pixel`.
/// bands: [phase][LANES], where a lane goes; weights: [phase][LANES][2], its weight there and in
/// the band above.
__kernel void film(__global float* sums, __global float* statistics, __global const float* radiance,
                   __global const PathState* paths, __global const int* bands,
                   __global const float* weights, __global const float* y_weights, uint first_pixel,
                   uint samples, uint pixel_count) {
    const uint pixel = (uint)get_global_id(0);
    if (pixel >= pixel_count)
        return;
    const size_t at = paths[(size_t)pixel * samples].pixel - first_pixel;
    __global float* base = sums + at * (FILM_ROWS * FILM_LANES);
    statistics += at * FILM_STATISTICS;
    float2 y_sum = vload2(0, statistics), y_compensation = vload2(1, statistics);
    for (uint s = 0u; s < samples; ++s) {
        const size_t path = (size_t)pixel * samples + s;
        const uint offset = paths[path].phase * LANES;
        float16 value[FILM_CHUNKS];
        if (!film_read(radiance + path * LANES, bands + offset, weights + 2u * offset, value)) {
            statistics[4] += 1.0f;
            continue;
        }
        const float sign = (paths[path].sample & 1u) ? -1.0f : 1.0f;
        for (uint c = 0u; c < FILM_CHUNKS; ++c) {
            const float16 sum = vload16(c, base);
            const float16 corrected = value[c] - vload16(c, base + FILM_LANES);
            const float16 next = sum + corrected;
            vstore16((next - sum) - corrected, c, base + FILM_LANES);
            vstore16(next, c, base);
            vstore16(vload16(c, base + 2 * FILM_LANES) + sign * value[c], c, base + 2 * FILM_LANES);
#if FEATURE_BAND_VARIANCE
            vstore16(vload16(c, base + 3 * FILM_LANES) + value[c] * value[c], c,
                     base + 3 * FILM_LANES);
#endif
        }
        const float y = film_luminance(value, y_weights);
        const float2 corrected = (float2)(y, y * y) - y_compensation;
        const float2 next = y_sum + corrected;
        y_compensation = (next - y_sum) - corrected;
        y_sum = next;
    }
    ((__global uint*)statistics)[5] += samples;
    vstore2(y_sum, 0, statistics);
    vstore2(y_compensation, 1, statistics);
}
