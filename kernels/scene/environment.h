// Light from an image around the scene, latitude by longitude: the top row looks along +y, the
// middle column along -z, columns to its right towards +x. Directions are sampled in proportion to
// what the texels shine onto the sphere.
#ifndef RERADIANT_ENVIRONMENT_H
#define RERADIANT_ENVIRONMENT_H

#include "kernels/core/portable.h"
#include "kernels/core/shared.h"
#include "kernels/core/table.h"

KERNELS_BEGIN

typedef struct {
    real u, v; ///< 0..1, v = 0 at +y
    real sin_theta;
} EnvironmentPlace;

DEVICE_FUNCTION EnvironmentPlace environment_place(EnvironmentRecord environment, Vec3 direction) {
    EnvironmentPlace place;
    place.sin_theta = sqrt(direction.x * direction.x + direction.z * direction.z);
    const real turn = atan2(direction.x, -direction.z) * (REAL(0.5) * INV_PI_REAL) + REAL(0.5) -
                      environment.rotation;
    place.u = turn - floor(turn);
    place.v = atan2(place.sin_theta, direction.y) * INV_PI_REAL;
    return place;
}

/// Pdf per solid angle of `environment_sample`.
DEVICE_FUNCTION real environment_pdf(EnvironmentRecord environment,
                                     GLOBAL_CONST shared_float* tables, EnvironmentPlace place) {
    uint column = (uint)(place.u * (real)environment.width);
    uint row = (uint)(place.v * (real)environment.height);
    column = column < environment.width ? column : environment.width - 1u;
    row = row < environment.height ? row : environment.height - 1u;
    const real density = tables[environment.density + row * environment.width + column];
    return density / (REAL(2.0) * PI_REAL * PI_REAL * fmax(place.sin_theta, REAL(1e-6)));
}

/// Direction from two uniform numbers; cumulative tables start with 0 and lack the final 1.
DEVICE_FUNCTION Vec3 environment_sample(EnvironmentRecord environment,
                                        GLOBAL_CONST shared_float* tables, real u1, real u2) {
    GLOBAL_CONST shared_float* marginal = tables + environment.marginal;
    const uint row = table_search(marginal + 1, environment.height - 1u, 1u, u1);
    GLOBAL_CONST shared_float* conditional =
        tables + environment.conditional + row * environment.width;
    const uint column = table_search(conditional + 1, environment.width - 1u, 1u, u2);
    const real row_end = row + 1u < environment.height ? marginal[row + 1u] : REAL(1.0);
    const real column_end = column + 1u < environment.width ? conditional[column + 1u] : REAL(1.0);
    const real along_row = (u1 - marginal[row]) / fmax(row_end - marginal[row], REAL(1e-20));
    const real along_column =
        (u2 - conditional[column]) / fmax(column_end - conditional[column], REAL(1e-20));
    const real theta =
        PI_REAL * ((real)row + fmin(along_row, REAL(0.999999))) / (real)environment.height;
    const real turn =
        ((real)column + fmin(along_column, REAL(0.999999))) / (real)environment.width - REAL(0.5) +
        environment.rotation;
    const real sin_theta = sin(theta);
    return vec3(sin_theta * sin(REAL(2.0) * PI_REAL * turn), cos(theta),
                -sin_theta * cos(REAL(2.0) * PI_REAL * turn));
}

/// Bilinear colour of the image, c = 0, 1, 2; columns repeat, rows stop at the poles.
DEVICE_FUNCTION real environment_colour(EnvironmentRecord environment,
                                        GLOBAL_CONST shared_float* tables, EnvironmentPlace place,
                                        uint c) {
    const real x = place.u * (real)environment.width - REAL(0.5);
    const real y = place.v * (real)environment.height - REAL(0.5);
    const real fx = floor(x), fy = floor(y);
    real sum = REAL(0.0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const real weight =
                (i ? x - fx : REAL(1.0) - (x - fx)) * (j ? y - fy : REAL(1.0) - (y - fy));
            const int columns = (int)environment.width, last = (int)environment.height - 1;
            const int column = ((int)fx + i + columns) % columns;
            int row = (int)fy + j;
            row = row < 0 ? 0 : (row > last ? last : row);
            sum += weight * tables[environment.image + 3u * (uint)(row * columns + column) + c];
        }
    return sum;
}

KERNELS_END

#endif
