// Device functions called over arrays, for comparison with the same source compiled in double.
// Each probe reads `stride_in` floats an item and writes `stride_out`.
#include "kernels/core/features.h"
#include "kernels/core/portable.h"
#include "kernels/core/random.h"
#include "kernels/core/sampling.h"
#include "kernels/core/sequence.h"
#include "kernels/core/shared.h"
#include "kernels/core/table.h"
#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/henyey_greenstein.h"
#include "kernels/scatter/microfacet.h"
#include "kernels/scene/camera.h"
#include "kernels/scene/lights.h"
#include "kernels/stack/layer_stack.h"
#include "kernels/stack/reradiation.h"
#include "kernels/walk/walk_microsurface.h"

#define ITEM                                                                                       \
    const uint i = (uint)get_global_id(0);                                                         \
    if (i >= count)                                                                                \
    return

__kernel void probe_fresnel(__global const float* in, __global float* out, uint count) {
    ITEM;
    out[2 * i] = fresnel_dielectric(in[2 * i], in[2 * i + 1]);
    out[2 * i + 1] = fresnel_cos_transmitted(in[2 * i], in[2 * i + 1]);
}

// in: distribution, alpha, wi, wo, u1, u2; out: D, reflection, pdf, sampled half vector
__kernel void probe_microfacet(__global const float* in, __global float* out, uint count) {
    ITEM;
    const int distribution = (int)in[10 * i];
    const float alpha = in[10 * i + 1];
    const Vec3 wi = vec3(in[10 * i + 2], in[10 * i + 3], in[10 * i + 4]);
    const Vec3 wo = vec3(in[10 * i + 5], in[10 * i + 6], in[10 * i + 7]);
    const Vec3 h = vec3_normalise(vec3_add(wi, wo));
    out[6 * i] = microfacet_d(distribution, alpha, h);
    out[6 * i + 1] = microfacet_reflection(distribution, alpha, wi, wo);
    out[6 * i + 2] = microfacet_pdf(distribution, alpha, wo, h);
    const Vec3 s = microfacet_sample(distribution, alpha, wo, in[10 * i + 8], in[10 * i + 9]);
    out[6 * i + 3] = s.x;
    out[6 * i + 4] = s.y;
    out[6 * i + 5] = s.z;
}

__kernel void probe_table(__global const float* in, __global float* out, uint count) {
    ITEM;
    const TableStencil s = table_stencil(in[i]);
    out[5 * i] = (float)s.node;
    out[5 * i + 1] = s.w0;
    out[5 * i + 2] = s.w1;
    out[5 * i + 3] = s.w2;
    out[5 * i + 4] = s.w3;
}

__kernel void probe_random(__global const float* in, __global float* out, uint count) {
    ITEM;
    const Random4 r = random_4(i, i * 7u + 1u, i % 13u, 42u);
    out[4 * i] = r.a;
    out[4 * i + 1] = r.b;
    out[4 * i + 2] = r.c;
    out[4 * i + 3] = r.d;
}

__kernel void probe_sequence(__global const float* in, __global float* out, uint count) {
    ITEM;
    const NumberBlock r = sequence_block(i / 7u, i, i % 9u, 42u);
    out[4 * i] = r.a;
    out[4 * i + 1] = r.b;
    out[4 * i + 2] = r.c;
    out[4 * i + 3] = r.d;
}

// in: type, position or normal, radius or area, u1, u2 (edges and normal are fixed); out: weight,
// pdf, distance, direction
__kernel void probe_lights(__global const float* in, __global float* out, uint count) {
    ITEM;
    LightRecord light;
    light.type = (uint)in[7 * i];
    light.px = in[7 * i + 1];
    light.py = in[7 * i + 2];
    light.pz = in[7 * i + 3];
    light.radius_or_area = in[7 * i + 4];
    light.ux = 2.0f, light.uy = 0.0f, light.uz = 0.0f;
    light.vx = 0.0f, light.vy = 0.0f, light.vz = 3.0f;
    light.nx = 0.0f, light.ny = -1.0f, light.nz = 0.0f;
    const LightSample s =
        lights_sample(light, vec3(0.0f, 0.0f, 0.0f), in[7 * i + 5], in[7 * i + 6]);
    out[6 * i] = s.weight;
    out[6 * i + 1] = s.pdf;
    out[6 * i + 2] = s.distance;
    out[6 * i + 3] = s.direction.x;
    out[6 * i + 4] = s.direction.y;
    out[6 * i + 5] = s.direction.z;
}

__kernel void probe_camera(__global const float* in, __global float* out, uint count,
                           CameraRecord camera) {
    ITEM;
    const CameraRay ray =
        camera_ray(camera, in[4 * i], in[4 * i + 1], in[4 * i + 2], in[4 * i + 3]);
    out[6 * i] = ray.origin.x;
    out[6 * i + 1] = ray.origin.y;
    out[6 * i + 2] = ray.origin.z;
    out[6 * i + 3] = ray.direction.x;
    out[6 * i + 4] = ray.direction.y;
    out[6 * i + 5] = ray.direction.z;
}

// in: wi, wo; out: factor of model A over the layers, refracted cosines
__kernel void probe_descend(__global const float* in, __global float* out, uint count,
                            __global const LayerRecord* layers, uint layer_count) {
    ITEM;
    Vec3 wi = vec3(in[6 * i], in[6 * i + 1], in[6 * i + 2]);
    Vec3 wo = vec3(in[6 * i + 3], in[6 * i + 4], in[6 * i + 5]);
    const LayerDescent descent = model_a_descend(layers, layer_count, 0, wi, wo);
    out[3 * i] = descent.way_in * descent.way_out;
    out[3 * i + 1] = descent.wi.z;
    out[3 * i + 2] = descent.wo.z;
}

__kernel void probe_phase(__global const float* in, __global float* out, uint count) {
    ITEM;
    out[i] = henyey_greenstein_phase(in[2 * i], in[2 * i + 1]);
}

// in, out: LANES values an item; factors: [2 * rank][LANES]
__kernel void probe_factored(__global const float* in, __global float* out, uint count,
                             __global const float* factors, uint rank) {
    ITEM;
    float16 down[CHUNKS], up[CHUNKS];
    for (uint c = 0u; c < CHUNKS; ++c) {
        down[c] = vload16(c, in + i * LANES);
        up[c] = (float16)(0.0f);
    }
    reradiation_factored(down, up, factors, rank);
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16(up[c], c, out + i * LANES);
}

__kernel void probe_dense(__global const float* in, __global float* out, uint count,
                          __global const float* matrix) {
    ITEM;
    float16 down[CHUNKS], up[CHUNKS];
    for (uint c = 0u; c < CHUNKS; ++c) {
        down[c] = vload16(c, in + i * LANES);
        up[c] = (float16)(0.0f);
    }
    reradiation_dense(down, up, matrix);
    for (uint c = 0u; c < CHUNKS; ++c)
        vstore16(up[c], c, out + i * LANES);
}

// in: distribution, alpha, eta, v, w, height, u; out: visible area, densities of reflection and
// refraction (all of it), probability of escape, next height, and that of a ray that stays
__kernel void probe_walk_facets(__global const float* in, __global float* out, uint count) {
    ITEM;
    __global const float* p = in + 11 * i;
    const WalkSurface surface = {(int)p[0], p[1], p[2], 1, 0, 0};
    const Vec3 v = vec3(p[3], p[4], p[5]), w = vec3(p[6], p[7], p[8]);
    const Vec3 h = walk_half_reflected(v, w);
    const WalkRefraction r = walk_refraction(surface, v, walk_mirrored(w));
    out[6 * i] = walk_visible_area(surface, v);
    out[6 * i + 1] = walk_reflection_density(surface, v, h, 1.0f);
    out[6 * i + 2] = walk_refraction_density(surface, v, r, 1.0f);
    out[6 * i + 3] = walk_escape(surface, w, p[9]);
    out[6 * i + 4] = walk_next_height(surface, w, p[9], p[10]);
    out[6 * i + 5] = walk_met_height(surface, w, p[9], p[10]);
}
