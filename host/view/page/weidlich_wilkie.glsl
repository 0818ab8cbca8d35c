// Weidlich and Wilkie 2007: each part of a stack adds its own light, seen through the parts above it.
#define RR_RESIDUAL 0

// What two directions meet on their way down; it depends on the band only where an IOR does.
struct RrGeometry {
    float cos_i, cos_o;
    float meets_i[RR_LAYERS + 1], meets_o[RR_LAYERS + 1], facets[RR_LAYERS + 1]; // at each interface
    float cos_h[RR_LAYERS + 1], lobe[RR_LAYERS + 1];
    vec3 fresnel[RR_LAYERS + 1]; // at the half vector and on both ways, where no table says it
    float slab_i[RR_LAYERS + 1], slab_o[RR_LAYERS + 1], phase[RR_LAYERS + 1]; // beneath it
    float flake_h[RR_LAYERS + 1], flakes[RR_LAYERS + 1];
    float shape, passes;
};

// Reflectance of an interface: of a table where it is not Fresnel's of a plain one.
vec4 rr_reflectance(int layer, int chunk, float cosine, float fresnel) {
    int table = rr_layer_table[layer];
    return table < 0 ? vec4(fresnel) : rr_table(table, chunk, cosine);
}

float rr_phase(float g, float deflection) {
    float d = g < 0.0 ? rr_square(1.0 + g) - 2.0 * g * (1.0 + deflection)
                      : rr_square(1.0 - g) + 2.0 * g * (1.0 - deflection);
    return (1.0 - g) * (1.0 + g) / (4.0 * RR_PI * d * sqrt(max(d, 1e-30)));
}
float rr_lit_lobe(int distribution, float alpha, vec3 lit, vec3 wo, float sin_radius) {
    if (alpha <= 0.0) return 0.0;
    return rr_facet_lobe(distribution, alpha, lit, wo) * rr_spread(alpha, sin_radius);
}

RrGeometry rr_geometry_at(vec3 wi, vec3 wo, float sin_radius, float ior[RR_LAYERS + 1]) {
    RrGeometry g;
    vec3 lit = rr_nearest_of_disc(wi, wo, sin_radius);
    float above = 1.0;
    g.cos_i = wi.z;
    g.cos_o = wo.z;
    for (int k = 0; k < RR_LAYERS; ++k) {
        vec3 h = normalize(wi + wo), lit_h = normalize(lit + wo);
        float alpha = rr_layer_alpha[k], eta = ior[k] / above;
        // what bears a film lets through what it does not reflect at the normal, without facets
        bool is_rough = alpha > 0.0 && rr_layer_table[k] < 0;
        g.meets_i[k] = is_rough ? max(dot(wi, h), 0.0) : wi.z;
        g.meets_o[k] = is_rough ? g.meets_i[k] : wo.z;
        g.facets[k] = is_rough ? rr_shadowing(rr_layer_distribution[k], alpha, wi, wo, h) * wi.z * wo.z : 1.0;
        g.cos_h[k] = dot(lit, lit_h);
        g.lobe[k] = rr_lit_lobe(rr_layer_distribution[k], alpha, lit, wo, sin_radius);
        g.fresnel[k].y = rr_fresnel(g.meets_i[k], eta);
        g.fresnel[k].x = g.cos_h[k] == g.meets_i[k] ? g.fresnel[k].y : rr_fresnel(g.cos_h[k], eta);
        g.fresnel[k].z = is_rough ? g.fresnel[k].y : rr_fresnel(g.meets_o[k], eta);
        wi = rr_refracted(wi, eta);
        wo = rr_refracted(wo, eta);
        lit = rr_refracted(lit, eta);
        g.slab_i[k] = wi.z;
        g.slab_o[k] = wo.z;
        g.phase[k] = rr_phase(rr_layer_anisotropy[k], -dot(wi, wo));
        g.flake_h[k] = dot(lit, normalize(lit + wo));
        g.flakes[k] = rr_lit_lobe(rr_flake_distribution[k], rr_flake_alpha[k], lit, wo, sin_radius);
        above = ior[k];
    }
    g.passes = wi.z > 0.0 && wo.z > 0.0 ? 1.0 : 0.0;
    g.cos_h[RR_LAYERS] = dot(lit, normalize(lit + wo));
    g.lobe[RR_LAYERS] = rr_lit_lobe(rr_base_distribution, rr_base_alpha, lit, wo, sin_radius);
    g.shape = rr_oren_nayar(rr_sigma, wi, wo);
    return g;
}
RrGeometry rr_geometry_of_band(vec3 wi, vec3 wo, float sin_radius, int chunk, int lane) {
    float ior[RR_LAYERS + 1];
    for (int k = 0; k < RR_LAYERS; ++k) ior[k] = RR_BAND(RR_IOR_ROW + k, chunk)[lane];
    ior[RR_LAYERS] = 1.0;
    return rr_geometry_at(wi, wo, sin_radius, ior);
}
RrGeometry rr_geometry(vec3 wi, vec3 wo, float sin_radius) {
    return rr_geometry_of_band(wi, wo, sin_radius, 0, 0);
}

vec4 rr_through_slab(vec4 depth, float cosine) { return exp(-depth / max(cosine, 1e-6)); }

// Of the directions that are looked at; as an argument it would be copied for every chunk.
RrGeometry rr_here;

// Radiance over irradiance at normal incidence `light`, bands of a chunk.
vec4 rr_chunk(int chunk, vec4 light, inout RrSums first, inout RrSums rest) {
    vec4 lit = light * rr_here.cos_i, in_ = vec4(1.0), out_ = vec4(1.0);
    vec4 mirrored = rr_table(RR_RESIDUAL, chunk, rr_here.cos_i) * rr_table(RR_RESIDUAL, chunk, rr_here.cos_o);
    for (int k = 0; k < RR_LAYERS; ++k) {
        vec4 depth = RR_BAND(RR_DEPTH_ROW + 2 * k, chunk);
        if (rr_here.lobe[k] > 0.0)
            mirrored += in_ * out_ * rr_here.lobe[k] * rr_reflectance(k, chunk, rr_here.cos_h[k], rr_here.fresnel[k].x);
        in_ *= 1.0 - rr_reflectance(k, chunk, rr_here.meets_i[k], rr_here.fresnel[k].y);
        out_ *= 1.0 - rr_here.facets[k] * rr_reflectance(k, chunk, rr_here.meets_o[k], rr_here.fresnel[k].z);
        if (rr_layer_is_cloudy[k]) {
            vec4 both = depth * (1.0 / max(rr_here.slab_i[k], 1e-6) + 1.0 / max(rr_here.slab_o[k], 1e-6));
            mirrored += in_ * out_ * rr_here.phase[k] / (rr_here.slab_i[k] + rr_here.slab_o[k]) *
                        RR_BAND(RR_DEPTH_ROW + 2 * k + 1, chunk) * (1.0 - exp(-both));
        }
        if (any(greaterThan(depth, vec4(0.0)))) {
            in_ *= rr_through_slab(depth, rr_here.slab_i[k]);
            out_ *= rr_through_slab(depth, rr_here.slab_o[k]);
        }
        float coverage = rr_flake_coverage[k];
        if (coverage > 0.0) {
            mirrored += in_ * out_ * coverage * rr_here.flakes[k] * rr_table(rr_flake_table[k], chunk, rr_here.flake_h[k]);
            in_ *= 1.0 - coverage;
            out_ *= 1.0 - coverage;
        }
    }
    in_ *= rr_here.passes;
    if (rr_base_table >= 0) {
        if (rr_here.lobe[RR_LAYERS] > 0.0)
            mirrored += in_ * out_ * rr_here.lobe[RR_LAYERS] * rr_table(rr_base_table, chunk, rr_here.cos_h[RR_LAYERS]);
        return mirrored * lit;
    }
#if RR_DENSE
    // tabulated for smooth interfaces, of the lamp that is lit
    vec4 sent = rr_here.passes * rr_here.cos_i * rr_table(RR_SENT, chunk, rr_here.cos_i);
#else
    vec4 sent = rr_operator(0, chunk, in_ * lit, first);
#endif
    return out_ * rr_here.shape / RR_PI * sent + mirrored * lit;
}

// Weight of the mirror direction, of smooth interfaces, flakes and a smooth conductor.
vec4 rr_mirror(int chunk, float cosine) {
    vec4 sum = vec4(0.0), through = vec4(1.0), above = vec4(1.0);
    float c = cosine;
    for (int k = 0; k < RR_LAYERS; ++k) {
        vec4 ior = RR_BAND(RR_IOR_ROW + k, chunk), eta = ior / above;
        int table = rr_layer_table[k];
        vec4 reflected = table < 0 ? rr_fresnel4(c, eta) : rr_table(table, chunk, c);
        if (rr_layer_alpha[k] == 0.0) sum += through * reflected;
        through *= (1.0 - reflected) * (1.0 - reflected);
        c = rr_refracted(vec3(sqrt(1.0 - c * c), 0.0, c), eta.x).z;
        through *= exp(-2.0 * RR_BAND(RR_DEPTH_ROW + 2 * k, chunk) / max(c, 1e-6));
        if (rr_flake_coverage[k] > 0.0) {
            if (rr_flake_alpha[k] == 0.0)
                sum += through * rr_flake_coverage[k] * rr_table(rr_flake_table[k], chunk, c);
            through *= rr_square(1.0 - rr_flake_coverage[k]);
        }
        above = ior;
    }
    if (rr_base_table >= 0 && rr_base_alpha == 0.0) sum += through * rr_table(rr_base_table, chunk, c);
    return sum;
}
