// One pixel of the page: what is hit, and what it sends to the eye under the lamp and the light around.
uniform vec2 rr_size;
uniform vec3 rr_eye, rr_lamp;            // place of the eye; direction to the lamp
uniform float rr_view_scale, rr_lamp_sine; // tangent of half the field of view; sine of the lamp's radius
uniform int rr_shape;                    // 0 sphere, 1 flat sample, 2 mesh
uniform mat3 rr_turn;                    // of the object, to the world
uniform float rr_around;                 // 1 where light comes from all around
in vec3 rr_point, rr_normal_of_mesh;
out vec4 rr_colour;

// Where the ray meets the object: its normal; false where it passes.
bool rr_hit(vec3 ray, out vec3 normal) {
    if (rr_shape == 2) {
        normal = normalize(rr_normal_of_mesh);
        return true;
    }
    if (rr_shape == 1) {
        normal = rr_turn[2];
        float along = dot(normal, ray);
        if (along == 0.0) return false;
        float t = -dot(normal, rr_eye) / along;
        vec3 point = transpose(rr_turn) * (rr_eye + t * ray);
        if (along > 0.0) normal = -normal;
        return t > 0.0 && max(abs(point.x), abs(point.y)) <= 1.0;
    }
    float b = dot(rr_eye, ray), c = dot(rr_eye, rr_eye) - 1.0, root = b * b - c;
    if (root < 0.0) return false;
    normal = normalize(rr_eye + (-b - sqrt(root)) * ray);
    return true;
}
vec3 rr_ray() {
    if (rr_shape == 2) return normalize(rr_point - rr_eye);
    vec2 place = (2.0 * gl_FragCoord.xy - rr_size) / rr_size.y * rr_view_scale;
    return normalize(vec3(place, -1.0));
}
vec3 rr_local(vec3 normal, vec3 w) {
    vec3 side = abs(normal.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    vec3 x = normalize(cross(side, normal));
    return vec3(dot(w, x), dot(w, cross(normal, x)), dot(w, normal));
}
vec3 rr_seen(vec4 radiance, int chunk) {
    return vec3(dot(radiance, RR_BAND(RR_WEIGHT_ROW, chunk)), dot(radiance, RR_BAND(RR_WEIGHT_ROW + 1, chunk)),
                dot(radiance, RR_BAND(RR_WEIGHT_ROW + 2, chunk)));
}
// Share of the disc's mirror image that the pixel shows, its edge softened.
float rr_disc(vec3 wi, vec3 wo) {
    if (rr_lamp_sine <= 0.0) return 0.0;
    float away = acos(clamp(dot(vec3(-wo.xy, wo.z), wi), -1.0, 1.0)), radius = asin(rr_lamp_sine);
    return 1.0 - smoothstep(0.94 * radius, 1.06 * radius, away);
}
vec3 rr_shade(vec3 wi, vec3 wo) {
    vec3 sum = vec3(0.0);
    RrSums first, rest;
    for (int k = 0; k <= RR_TERMS; ++k) first.terms[k] = rest.terms[k] = 0.0;
    bool is_lit = wi.z > 0.0;
    vec3 from = is_lit ? wi : wo;
    float disc = is_lit ? rr_disc(wi, wo) / (RR_PI * max(rr_lamp_sine * rr_lamp_sine, 1e-12)) : 0.0;
#if !RR_DISPERSIVE
    rr_here = rr_geometry(from, wo, rr_lamp_sine);
#endif
    for (int chunk = 0; chunk < RR_CHUNKS; ++chunk) {
        vec4 lamp = RR_BAND(RR_LAMP_ROW, chunk), radiance = vec4(0.0);
        if (is_lit) {
#if RR_DISPERSIVE
            for (int lane = 0; lane < 4; ++lane) {
                vec4 one = vec4(equal(ivec4(0, 1, 2, 3), ivec4(lane)));
                rr_here = rr_geometry_of_band(from, wo, rr_lamp_sine, chunk, lane);
                // a band at a time, so that the running sums grow by its light alone
                radiance += one * rr_chunk(chunk, one * lamp, first, rest);
            }
#else
            radiance = rr_chunk(chunk, lamp, first, rest);
#endif
            if (disc > 0.0) radiance += disc * lamp * rr_mirror(chunk, wi.z);
        }
        if (rr_around > 0.0) radiance += rr_table(RR_AROUND, chunk, wo.z);
        sum += rr_seen(radiance, chunk);
    }
    return sum;
}
vec3 rr_encoded(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
void main() {
    vec3 normal, ray = rr_ray();
    rr_colour = vec4(0.0);
    if (!rr_hit(ray, normal)) return;
    vec3 wo = rr_local(normal, -ray), wi = rr_local(normal, rr_lamp);
    if (wo.z <= 0.0) return;
    rr_colour = vec4(rr_encoded(rr_shade(wi, wo)), 1.0);
}
