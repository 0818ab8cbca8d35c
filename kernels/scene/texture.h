// Textures: a number t in 0..1 (and, for some, a colour and a tilt of the normal) at every point of
// a surface. What t stands for is the material's affair: the host tabulates one material for each
// level of its textures.
#ifndef RERADIANT_TEXTURE_H
#define RERADIANT_TEXTURE_H

#include "kernels/core/portable.h"
#include "kernels/core/random.h"
#include "kernels/core/shared.h"

KERNELS_BEGIN

/// A `TexturePoint` is what a texture says about a point. slope_x and slope_y are the tangents of
/// the normal's tilt along the two axes of the local frame, 0 for textures without a tilt.
typedef struct {
    real value;
    real red, green, blue; ///< linear colour of an image; otherwise `value` three times
    real slope_x, slope_y;
} TexturePoint;

DEVICE_FUNCTION uint texture_hash(int x, int y, int z, uint seed) {
    return random_hash((uint)x + random_hash((uint)y + random_hash((uint)z, seed), seed), seed);
}

DEVICE_FUNCTION real texture_unit(real t) {
    return fmin(fmax(t, REAL(0.0)), REAL(1.0));
}

/// Dot product of a lattice point's gradient (one of 12 edges of a cube) with the offset from it.
DEVICE_FUNCTION real texture_gradient(uint hash, real x, real y, real z) {
    const uint h = hash & 15u;
    const real u = h < 8u ? x : y;
    const real v = h < 4u ? y : (h == 12u || h == 14u ? x : z);
    return ((h & 1u) == 0u ? u : -u) + ((h & 2u) == 0u ? v : -v);
}

DEVICE_FUNCTION real texture_fade(real t) {
    return t * t * t * (t * (t * REAL(6.0) - REAL(15.0)) + REAL(10.0));
}

DEVICE_FUNCTION real texture_mix(real a, real b, real t) {
    return a + t * (b - a);
}

/// Gradient noise, about -1..1 (Perlin 2002, "Improving noise", with hashed gradients).
DEVICE_FUNCTION real texture_gradient_noise(Vec3 p, uint seed) {
    const real fx = floor(p.x), fy = floor(p.y), fz = floor(p.z);
    const int ix = (int)fx, iy = (int)fy, iz = (int)fz;
    const real x = p.x - fx, y = p.y - fy, z = p.z - fz;
    const real u = texture_fade(x), v = texture_fade(y), w = texture_fade(z);
    real plane[2];
    for (int k = 0; k < 2; ++k) {
        real row[2];
        for (int j = 0; j < 2; ++j) {
            const real near = texture_gradient(texture_hash(ix, iy + j, iz + k, seed), x,
                                               y - (real)j, z - (real)k);
            const real far = texture_gradient(texture_hash(ix + 1, iy + j, iz + k, seed),
                                              x - REAL(1.0), y - (real)j, z - (real)k);
            row[j] = texture_mix(near, far, u);
        }
        plane[k] = texture_mix(row[0], row[1], v);
    }
    return texture_mix(plane[0], plane[1], w);
}

/// Octaves of noise, each twice as fine and half as strong as the one before.
DEVICE_FUNCTION real texture_octaves(Vec3 p, uint octaves, uint seed) {
    real sum = REAL(0.0), strength = REAL(1.0), frequency = REAL(1.0), total = REAL(0.0);
    for (uint i = 0u; i < octaves; ++i) {
        sum += strength * texture_gradient_noise(vec3_scale(p, frequency), seed + i);
        total += strength;
        strength *= REAL(0.5);
        frequency *= REAL(2.0);
    }
    return sum / fmax(total, REAL(1e-30));
}

DEVICE_FUNCTION TexturePoint texture_flat(real value) {
    TexturePoint point;
    point.value = point.red = point.green = point.blue = value;
    point.slope_x = point.slope_y = REAL(0.0);
    return point;
}

DEVICE_FUNCTION TexturePoint texture_noise(TextureRecord texture, Vec3 p) {
    TexturePoint point = texture_flat(texture_unit(
        REAL(0.5) + texture.sharpness * texture_octaves(p, texture.octaves, texture.seed)));
    if (texture.tilt > 0.0f) {
        // gradient noise has a standard deviation of about 1/4
        const real scale = REAL(4.0) * texture.tilt;
        point.slope_x = scale * texture_octaves(p, texture.octaves, texture.seed + 101u);
        point.slope_y = scale * texture_octaves(p, texture.octaves, texture.seed + 202u);
    }
    return point;
}

/// Flakes: every point belongs to the nearest of points scattered one to a lattice cell (Worley
/// 1996); a flake has one value, uniform in 0..1 or (share) 0 or 1, and one tilt, normally
/// distributed.
DEVICE_FUNCTION TexturePoint texture_voronoi(TextureRecord texture, Vec3 p) {
    const real fx = floor(p.x), fy = floor(p.y), fz = floor(p.z);
    const int deep = texture.space == TEXTURE_WORLD ? 1 : 0;
    real nearest = REAL(1e30);
    uint owner = 0u;
    for (int k = -deep; k <= deep; ++k)
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
                const uint hash = texture_hash((int)fx + i, (int)fy + j, (int)fz + k, texture.seed);
                const Random4 u = random_4(hash, 0u, 0u, texture.seed);
                const Vec3 d = vec3(fx + (real)i + u.a - p.x, fy + (real)j + u.b - p.y,
                                    deep ? fz + (real)k + u.c - p.z : REAL(0.0));
                const real distance2 = vec3_dot(d, d);
                if (distance2 < nearest) {
                    nearest = distance2;
                    owner = hash;
                }
            }
    const Random4 own = random_4(owner, 1u, 0u, texture.seed);
    const real chosen = own.a < texture.share ? REAL(1.0) : REAL(0.0);
    TexturePoint point = texture_flat(texture.share > 0.0f ? chosen : own.a);
    // Box and Muller 1958
    const real radius = texture.tilt * sqrt(REAL(-2.0) * log(REAL(1.0) - own.b));
    point.slope_x = radius * cos(REAL(2.0) * PI_REAL * own.c);
    point.slope_y = radius * sin(REAL(2.0) * PI_REAL * own.c);
    return point;
}

/// A floor at y = 0 lies between two layers of cubes: moved by a bit, rounding does not mix them.
DEVICE_FUNCTION TexturePoint texture_checker(Vec3 p) {
    const real bit = REAL(1e-4);
    const int sum = (int)floor(p.x + bit) + (int)floor(p.y + bit) + (int)floor(p.z + bit);
    return texture_flat((real)(sum & 1));
}

DEVICE_FUNCTION uint texture_wrap(int i, uint size) {
    const int n = (int)size;
    const int rest = i % n;
    return (uint)(rest < 0 ? rest + n : rest);
}

/// Bilinear, repeating; row 0 is at v = 1.
DEVICE_FUNCTION TexturePoint texture_image(TextureRecord texture, Vec3 p,
                                           GLOBAL_CONST shared_float* data) {
    const real x = p.x * (real)texture.width - REAL(0.5);
    const real y = -p.y * (real)texture.height - REAL(0.5);
    const real fx = floor(x), fy = floor(y);
    real rgb[3] = {REAL(0.0), REAL(0.0), REAL(0.0)};
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const real weight =
                (i ? x - fx : REAL(1.0) - (x - fx)) * (j ? y - fy : REAL(1.0) - (y - fy));
            const uint column = texture_wrap((int)fx + i, texture.width);
            const uint row = texture_wrap((int)fy + j, texture.height);
            GLOBAL_CONST shared_float* texel =
                data + texture.image + 3u * (row * texture.width + column);
            for (int c = 0; c < 3; ++c)
                rgb[c] += weight * texel[c];
        }
    TexturePoint point;
    point.red = rgb[0];
    point.green = rgb[1];
    point.blue = rgb[2];
    // luminance of linear sRGB (IEC 61966-2-1)
    point.value =
        texture_unit(REAL(0.2126) * rgb[0] + REAL(0.7152) * rgb[1] + REAL(0.0722) * rgb[2]);
    point.slope_x = point.slope_y = REAL(0.0);
    if (texture.is_normal_map) {
        const real z = fmax(REAL(2.0) * rgb[2] - REAL(1.0), REAL(0.05));
        point.slope_x = (REAL(2.0) * rgb[0] - REAL(1.0)) / z;
        point.slope_y = (REAL(2.0) * rgb[1] - REAL(1.0)) / z;
    }
    return point;
}

/// `data`: the tables that the record's image offset counts from.
DEVICE_FUNCTION TexturePoint texture_at(TextureRecord texture, Vec3 position, real u, real v,
                                        GLOBAL_CONST shared_float* data) {
    const Vec3 place = texture.space == TEXTURE_WORLD ? position : vec3(u, v, REAL(0.0));
    const Vec3 p = vec3_scale(place, texture.inverse_size);
    if (texture.type == TEXTURE_NOISE)
        return texture_noise(texture, p);
    if (texture.type == TEXTURE_VORONOI)
        return texture_voronoi(texture, p);
    if (texture.type == TEXTURE_CHECKER)
        return texture_checker(p);
    return texture_image(texture, vec3_scale(vec3(u, v, REAL(0.0)), texture.inverse_size), data);
}

/// One of the two levels that t lies between, at random so that the mean is linear in t.
DEVICE_FUNCTION uint texture_level(real value, uint levels, real random) {
    const real position = texture_unit(value) * (real)(levels - 1u);
    uint level = (uint)position;
    level = level > levels - 2u ? levels - 2u : level;
    return random < position - (real)level ? level + 1u : level;
}

KERNELS_END

#endif
