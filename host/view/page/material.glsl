// What a layered material sends towards wo of a lamp's light along -wi, band by band, four bands in a
// vector. Directions are unit vectors in the surface's frame, whose z is the normal; values have the
// cosine of wi in them. The formulas are those of the renderer's kernels: Walter et al. 2007 and Heitz
// 2014 for facets, Weidlich and Wilkie 2007 for their model, adding for all interreflections.
//
// Whoever includes this defines RR_BAND(row, chunk), four numbers of a quantity by band, and
// RR_NODE(table, chunk, node), four numbers of a function of the cosine at its node; nodes are uniform
// in the square root of the cosine.
const float RR_PI = 3.14159265358979;

float rr_square(float x) { return x * x; }
float rr_sum(vec4 v) { return v.x + v.y + v.z + v.w; }

// A tabulated function of the cosine, linear between its nodes.
vec4 rr_table(int table, int chunk, float cosine) {
    float x = sqrt(clamp(cosine, 0.0, 1.0)) * float(RR_NODES - 1);
    int node = min(int(x), RR_NODES - 2);
    return mix(RR_NODE(table, chunk, node), RR_NODE(table, chunk, node + 1), x - float(node));
}

// Reflectance of a dielectric interface, eta = n below / n above (Born and Wolf, 1.5.2).
float rr_fresnel(float c, float eta) {
    float excess = (eta - 1.0) * (eta + 1.0);
    float g2 = excess + c * c;
    if (eta == 1.0) return 0.0;
    if (g2 <= 0.0) return 1.0;
    float g = sqrt(g2);
    float s = excess / rr_square(c + g);
    float p = excess * ((excess + 2.0) * c * c - 1.0) / rr_square(eta * eta * c + g);
    return min(0.5 * (s * s + p * p), 1.0);
}
vec4 rr_fresnel4(float c, vec4 eta) {
    return vec4(rr_fresnel(c, eta.x), rr_fresnel(c, eta.y), rr_fresnel(c, eta.z), rr_fresnel(c, eta.w));
}
vec3 rr_refracted(vec3 w, float eta) {
    float g2 = (eta - 1.0) * (eta + 1.0) + w.z * w.z;
    return vec3(w.xy / eta, g2 <= 0.0 ? 0.0 : min(sqrt(g2) / eta, 1.0));
}

// Abramowitz and Stegun 7.1.26, error below 1.5e-7, for x >= 0.
float rr_erfc(float x) {
    float t = 1.0 / (1.0 + 0.3275911 * x);
    return exp(-x * x) * t *
        (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
}

// Density of facet normals: 0 blinn, 1 beckmann, 2 ggx.
float rr_facet_density(int distribution, float alpha, vec3 h) {
    float sin2 = dot(h.xy, h.xy), cos2 = h.z * h.z, a2 = alpha * alpha;
    if (h.z <= 0.0) return 0.0;
    if (distribution == 2) return 1.0 / (RR_PI * a2 * rr_square(cos2 + sin2 / a2));
    if (distribution == 1) return exp(-min(sin2 / (cos2 * a2), 80.0)) / (RR_PI * a2 * cos2 * cos2);
    // log(1 - sin2) by its series where single precision would lose it
    float log_cos2 = sin2 < 0.01 ? -sin2 * (1.0 + sin2 * (0.5 + sin2 / 3.0)) : log(cos2);
    return exp(max(1.0 / a2 - 1.0, 0.0) * log_cos2) / (RR_PI * a2);
}
float rr_lambda_cos(int distribution, float alpha, vec3 w) {
    float s = alpha * length(w.xy);
    if (s <= 0.0) return 0.0;
    if (distribution == 1) {
        float a = w.z / s;
        return a > 4.0 ? 0.0 : 0.5 * max(s * exp(-a * a) / sqrt(RR_PI) - w.z * rr_erfc(a), 0.0);
    }
    return 0.5 * s * s / (w.z + sqrt(w.z * w.z + s * s));
}
// Masking and shadowing over the product of the cosines.
float rr_shadowing(int distribution, float alpha, vec3 wi, vec3 wo, vec3 h) {
    float cc = wi.z * wo.z;
    if (distribution == 0)
        return min(1.0 / cc, min(2.0 * h.z / (dot(wi, h) * wo.z), 2.0 * h.z / (dot(wo, h) * wi.z)));
    return 1.0 / (cc + wo.z * rr_lambda_cos(distribution, alpha, wi) +
                  wi.z * rr_lambda_cos(distribution, alpha, wo));
}
// D G / (4 cos cos), without Fresnel and cosine.
float rr_facet_lobe(int distribution, float alpha, vec3 wi, vec3 wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return 0.0;
    vec3 h = normalize(wi + wo);
    return 0.25 * rr_facet_density(distribution, alpha, h) * rr_shadowing(distribution, alpha, wi, wo, h);
}

// Oren and Nayar 1994, qualitative form, times pi over the reflectance; 1 for sigma 0.
float rr_oren_nayar(float sigma, vec3 wi, vec3 wo) {
    float s2 = sigma * sigma, along = dot(wi.xy, wo.xy);
    if (wi.z <= 0.0 || wo.z <= 0.0) return 0.0;
    return 1.0 - 0.5 * s2 / (s2 + 0.33) +
        0.45 * s2 / (s2 + 0.09) * (along > 0.0 ? along / max(wi.z, wo.z) : 0.0);
}

// A lamp that is a disc: the point of it nearest the mirror direction lights a lobe, which is spread by
// the disc's width (Karis 2013); sin_radius 0 is a direction, and exact.
vec3 rr_nearest_of_disc(vec3 wi, vec3 wo, float sin_radius) {
    vec3 mirror = vec3(-wo.xy, wo.z);
    float away = acos(clamp(dot(mirror, wi), -1.0, 1.0)), radius = asin(sin_radius);
    if (away <= radius || radius <= 0.0) return radius > 0.0 ? mirror : wi;
    return normalize(mix(wi, mirror, radius / away));
}
float rr_spread(float alpha, float sin_radius) {
    return rr_square(alpha / min(alpha + 0.5 * sin_radius, 1.0));
}

// Re-radiation as a running sum over the bands: sent out at a band is what shorter ones took up.
struct RrSums { float terms[RR_TERMS + 1]; };

vec4 rr_operator(int operator, int chunk, vec4 light, inout RrSums sums) {
    int first = RR_OPERATOR_ROW + operator * (1 + 2 * RR_TERMS);
    vec4 sent = RR_BAND(first, chunk) * light;
    for (int k = 0; k < RR_TERMS; ++k) {
        vec4 taken = RR_BAND(first + 1 + 2 * k, chunk) * light;
        vec4 before = vec4(0.0, taken.x, taken.x + taken.y, taken.x + taken.y + taken.z);
        sent += RR_BAND(first + 2 + 2 * k, chunk) * (before + sums.terms[k]);
        sums.terms[k] += rr_sum(taken);
    }
    return sent;
}
