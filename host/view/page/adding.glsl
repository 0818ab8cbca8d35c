// Adding: every interreflection between a diffuse substrate and what lies above it.
#define RR_T 0
#define RR_DELTA 1
#define RR_RESIDUAL 2
#define RR_AMPLITUDE 3

// What of a pair of directions does not depend on the band.
struct RrGeometry {
    float cos_i, cos_o, cos_h, top, first, rest;
    float lobes[RR_LOBES + 1];
    float dyes[RR_DYE_NODES + 1]; // weights of the nodes that light of dyes in layers goes to
};

float rr_lobe_term(int distribution, float spread) {
    return distribution == 2 ? spread * sqrt(spread) : spread * spread;
}
float rr_normal(float ior, float sin2) { return sqrt(max(ior * ior - sin2, 0.0)); }
// Width of a deeper interface's lobe over the half vector in air.
float rr_lobe_width(int lobe, float cos_i, float cos_o) {
    float ior = rr_lobe_ior[lobe], alpha = rr_lobe_alpha[lobe];
    int distribution = rr_lobe_distribution[lobe];
    if (ior == 0.0) return alpha;
    vec2 sin2 = vec2((1.0 - cos_i) * (1.0 + cos_i), (1.0 - cos_o) * (1.0 + cos_o));
    float terms = rr_lobe_term(distribution, alpha * (rr_normal(ior, sin2.x) + rr_normal(ior, sin2.y)));
    for (int p = 0; p < RR_PASSAGES; ++p) {
        vec3 passage = rr_passage[lobe * RR_PASSAGES + p];
        for (int way = 0; way < 2; ++way)
            terms += rr_lobe_term(distribution, passage.x *
                abs(rr_normal(passage.z, sin2[way]) - rr_normal(passage.y, sin2[way])));
    }
    float spread = distribution == 2 ? exp(log(max(terms, 1e-30)) / 1.5) : sqrt(terms);
    return clamp(spread / max(cos_i + cos_o, 1e-6), 0.0009765625, 1.0);
}

#if RR_HAS_RATIO
// Ratio of the light of several facets to the lobe of one, linear between the nodes of its table.
float rr_ratio_at(float place_i, float place_o, float place) {
    int i = min(int(place_i), 14), o = min(int(place_o), 14), s = min(int(place), 15);
    float sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 step = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 t = vec3(place_i - float(i), place_o - float(o), place - float(s));
        vec3 weight = mix(1.0 - t, t, vec3(step));
        sum += weight.x * weight.y * weight.z * RR_RATIO((i + step.x) * 16 + o + step.y, s + step.z);
    }
    return sum;
}
float rr_ratio(float alpha, vec3 wi, vec3 wo) {
    vec2 sines = vec2(length(wi.xy), length(wo.xy));
    vec2 along = wi.xy / max(sines.x, 1e-9) + wo.xy / max(sines.y, 1e-9);
    float q = 0.25 * dot(along, along), sum = rr_square(alpha * max(wi.z + wo.z, 1e-9));
    float across = rr_square(max(sines.x + sines.y, 1e-9));
    float difference = sum * rr_square(wi.z - wo.z) / (alpha * alpha * across);
    float k = sqrt((sum + difference) / (sum + difference + 4.0 * sines.x * sines.y));
    vec2 places = clamp((sqrt(max(vec2(wi.z, wo.z), 0.0)) - 0.1) * (15.0 / 0.9), 0.0, 15.0);
    return rr_ratio_at(places.x, places.y, clamp(q * (1.0 + k) / (q + k), 0.0, 1.0) * 16.0);
}
#endif

#if RR_HAS_RETURNED
// Ratio of the light that comes back from a deeper interface to its lobe, from the first of two directions:
// linear in a table of 32 cosines, 28 slopes of the half vector and 9 azimuths.
float rr_azimuth_place(float cosine) {
    float x = min(abs(cosine), 1.0);
    float angle = sqrt(1.0 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - x * 0.0187293)));
    return (cosine < 0.0 ? RR_PI - angle : angle) * (8.0 / RR_PI);
}
float rr_returned_from(int lobe, vec3 own, vec3 other) {
    vec3 sum = own + other;
    float across = dot(sum.xy, sum.xy), largest = (1.0 + sqrt(max(1.0 - own.z * own.z, 0.0))) / max(own.z, 0.01);
    float u = min(sqrt(across) / max(sum.z, 1e-15) / largest, 1.0), k = 8.0 * rr_lobe_returned[lobe] / largest;
    float along = dot(own.xy, sum.xy) / sqrt(max(across * dot(own.xy, own.xy), 1e-30));
    vec3 place = vec3(clamp((sqrt(max(own.z, 0.0)) - 0.1) * (31.0 / 0.9), 0.0, 31.0),
                      u * (1.0 + k) / (u + k) * 27.0, rr_azimuth_place(along));
    ivec3 at = clamp(ivec3(place), ivec3(0), ivec3(30, 26, 7));
    vec3 t = place - vec3(at);
    float value = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 step = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 weight = mix(1.0 - t, t, vec3(step));
        value += weight.x * weight.y * weight.z *
            RR_RETURNED((lobe * 32 + at.x + step.x) * 28 + at.y + step.y, at.z + step.z);
    }
    return value;
}
#endif

#if RR_OPERATORS == 2
float rr_oren_nayar_place(float cosine) { return sqrt(max(1.0 - cosine, 0.0)) * 15.0; }
float rr_separable_albedo(float cosine) {
    float place = clamp(rr_oren_nayar_place(cosine), 0.0, 15.0);
    int node = min(int(place), 14);
    return mix(RR_SEPARABLE(node), RR_SEPARABLE(node + 1), place - float(node));
}
float rr_seen_substrate(vec3 wi, vec3 wo) {
#if RR_SPREADS
    float azimuth = dot(wi.xy, wo.xy) / max(length(wi.xy) * length(wo.xy), 1e-12);
    vec3 place = vec3(rr_oren_nayar_place(wi.z), rr_oren_nayar_place(wo.z), (azimuth + 1.0) * 8.0);
    int i = min(int(place.x), 14), o = min(int(place.y), 14), s = clamp(int(place.z), 0, 15);
    vec3 t = clamp(place - vec3(i, o, s), 0.0, 1.0);
    float sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 step = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 weight = mix(1.0 - t, t, vec3(step));
        sum += weight.x * weight.y * weight.z * RR_SPREAD((i + step.x) * 16 + o + step.y, s + step.z);
    }
    return sum;
#else
    return rr_oren_nayar(rr_sigma, rr_refracted(wi, rr_lowest_ior), rr_refracted(wo, rr_lowest_ior));
#endif
}
#endif

// Polynomials that are 1 at one of Chebyshev's nodes each.
float rr_dye_node(int node) { return 0.51 - 0.49 * cos(RR_PI * (float(node) + 0.5) / float(RR_DYE_NODES)); }
void rr_dye_weights(inout RrGeometry g) {
    for (int p = 0; p < RR_DYE_NODES; ++p) {
        g.dyes[p] = 1.0;
        for (int q = 0; q < RR_DYE_NODES; ++q)
            if (q != p) g.dyes[p] *= (g.cos_o - rr_dye_node(q)) / (rr_dye_node(p) - rr_dye_node(q));
    }
}

RrGeometry rr_geometry(vec3 wi, vec3 wo, float sin_radius) {
    RrGeometry g;
    vec3 lit = rr_nearest_of_disc(wi, wo, sin_radius);
    g.cos_i = wi.z;
    g.cos_o = wo.z;
    g.cos_h = dot(lit, normalize(lit + wo));
    g.top = rr_top_alpha > 0.0 ? rr_facet_lobe(rr_top_distribution, rr_top_alpha, lit, wo) *
                                     rr_spread(rr_top_alpha, sin_radius)
                               : 0.0;
    for (int l = 0; l < RR_LOBES; ++l) {
        float width = rr_lobe_width(l, lit.z, wo.z);
        g.lobes[l] = rr_facet_lobe(rr_lobe_distribution[l], width, lit, wo) * rr_spread(width, sin_radius);
#if RR_HAS_RATIO
        if (l == 0) g.lobes[l] *= rr_ratio(rr_lobe_alpha[l], lit, wo);
#endif
#if RR_HAS_RETURNED
        if (rr_lobe_returned[l] > 0.0) g.lobes[l] *= rr_returned_from(l, lit, wo) + rr_returned_from(l, wo, lit);
#endif
    }
    g.first = rr_oren_nayar(rr_sigma, wi, wo);
    g.rest = 0.0;
#if RR_OPERATORS == 2
    float mean = rr_mean_albedo, both = rr_separable_albedo(wi.z) * rr_separable_albedo(wo.z);
    g.first = rr_seen_substrate(wi, wo) - both / mean;
    g.rest = both / (mean * mean);
#endif
    rr_dye_weights(g);
    return g;
}

// Of the directions that are looked at; as an argument it would be copied for every chunk.
RrGeometry rr_here;

// Radiance over irradiance at normal incidence `light`, bands of a chunk.
vec4 rr_chunk(int chunk, vec4 light, inout RrSums first, inout RrSums rest) {
    vec4 lit = light * rr_here.cos_i;
#if RR_DYE_NODES > 0
    vec4 seen = vec4(0.0);
    for (int p = 0; p < RR_DYE_NODES; ++p)
        seen += rr_here.dyes[p] * rr_here.cos_i * rr_table(RR_SENT + p, chunk, rr_here.cos_i);
    seen *= rr_table(RR_T, chunk, rr_here.cos_o);
#else
#if RR_DENSE
    vec4 sent = rr_here.first * rr_here.cos_i * rr_table(RR_SENT, chunk, rr_here.cos_i);
#if RR_OPERATORS == 2
    sent += rr_here.rest * rr_here.cos_i * rr_table(RR_SENT + 1, chunk, rr_here.cos_i);
#endif
#else
    vec4 arrives = rr_table(RR_T, chunk, rr_here.cos_i) * lit;
    vec4 sent = rr_here.first * rr_operator(0, chunk, arrives, first);
#if RR_OPERATORS == 2
    sent += rr_here.rest * rr_operator(1, chunk, arrives, rest);
#endif
#endif
    vec4 seen = rr_table(RR_T, chunk, rr_here.cos_o) * RR_BAND(RR_SCALE_ROW, chunk) * sent;
#endif
    vec4 mirrored = rr_table(RR_RESIDUAL, chunk, rr_here.cos_i) * rr_table(RR_RESIDUAL, chunk, rr_here.cos_o);
    if (rr_here.top > 0.0) mirrored += rr_here.top * rr_fresnel4(rr_here.cos_h, RR_BAND(RR_IOR_ROW, chunk));
    for (int l = 0; l < RR_LOBES; ++l)
        mirrored += rr_here.lobes[l] * rr_table(RR_AMPLITUDE + l, chunk, rr_here.cos_i) *
                    rr_table(RR_AMPLITUDE + l, chunk, rr_here.cos_o);
    return seen + mirrored * lit;
}
// Weight of the mirror direction.
vec4 rr_mirror(int chunk, float cosine) { return rr_table(RR_DELTA, chunk, cosine); }
