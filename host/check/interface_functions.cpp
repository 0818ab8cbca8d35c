#include "host/check/checked_function.h"

#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/henyey_greenstein.h"
#include "kernels/scatter/microfacet.h"
#include "kernels/scatter/oren_nayar.h"
#include "kernels/scatter/thin_film.h"

namespace reradiant {

namespace {

const Accuracy few_ulp{2e-6, 1e-30, "a stable form, a dozen roundings"};
const Accuracy reflectance{5e-6, 1e-9, "differences keep their digits; below 1e-9 unseen"};
const Accuracy lobe{
    2e-5, 1e-4, "the exponent or power magnifies rounding; below 1e-4 of a matt surface unseen"};

/// Facets within four standard slopes, where nearly all of them are.
Argument slope() {
    return {Argument::Kind::Uniform, -4.0, 4.0, {0.0f, 1e-6f, 1.0f, -4.0f}};
}

std::vector<CheckedFunction> fresnel_functions() {
    const Argument index{Argument::Kind::Uniform, 0.05, 5.0, {0.05f, 0.999999f, 1.0f, 1.5f, 4.0f}};
    const Argument kappa{Argument::Kind::Uniform, 0.0, 10.0, {0.0f, 1e-6f, 0.1f, 3.0f, 10.0f}};
    return {
        CHECKED_FUNCTION("fresnel_dielectric", "kernels/scatter/fresnel.h",
                         (Arguments{cosine(), ior()}), 1, reflectance,
                         out[0] = fresnel_dielectric(in[0], in[1])),
            CHECKED_FUNCTION("fresnel_cos_transmitted", "kernels/scatter/fresnel.h",
                             (Arguments{cosine(), ior()}), 1,
                             (Accuracy{1e-5, 1e-3, "falls as a root at the critical angle"}),
                             out[0] = fresnel_cos_transmitted(in[0], in[1])),
            CHECKED_FUNCTION("fresnel_refracted", "kernels/scatter/fresnel.h",
                             (Arguments{direction(), ior()}), 3,
                             (Accuracy{1e-5, 1e-3, "z falls as a root at the critical angle"}),
                             const Vec3 w = fresnel_refracted(CHECK_VECTOR(0), in[3]);
                             CHECK_RESULT(0, w)),
            CHECKED_FUNCTION("fresnel_conductor", "kernels/scatter/fresnel.h",
                             (Arguments{cosine(), index, kappa}), 1, reflectance,
                             out[0] = fresnel_conductor(in[0], in[1], in[2])),
    };
}

std::vector<CheckedFunction> film_functions() {
    const Argument medium{Argument::Kind::Uniform, 1.0, 2.4, {1.0f, 1.33f, 1.5f, 2.4f}};
    const Argument kappa{Argument::Kind::Uniform, 0.0, 6.0, {0.0f, 0.0f, 1e-3f, 3.0f}};
    const Argument thickness{Argument::Kind::Uniform, 0.0, 1500.0, {0.0f, 1e-3f, 100.0f, 1500.0f}};
    const Argument wavelength{Argument::Kind::Uniform, 300.0, 780.0, {300.0f, 550.0f, 780.0f}};
    return {CHECKED_FUNCTION(
        "thin_film_reflectance", "kernels/scatter/thin_film.h",
        (Arguments{cosine(), medium, medium, medium, kappa, thickness, wavelength}), 1,
        (Accuracy{5e-5, 1e-2, "the phase, up to 75 radians, is wrong by as many roundings"}),
        out[0] = thin_film_reflectance(in[0], in[1], in[2], in[3], in[4], in[5], in[6]))};
}

std::vector<CheckedFunction> oren_nayar_functions() {
    const Argument sigma{Argument::Kind::Uniform, 0.0, 1.6, {0.0f, 1e-4f, 0.2f, 0.34f, 1.57f}};
    return {
        CHECKED_FUNCTION("oren_nayar_value", "kernels/scatter/oren_nayar.h",
                         (Arguments{sigma, direction(), direction()}), 1, few_ulp,
                         out[0] = oren_nayar_value(in[0], CHECK_VECTOR(1), CHECK_VECTOR(4))),
        CHECKED_FUNCTION("oren_nayar_albedo", "kernels/scatter/oren_nayar.h",
                         (Arguments{sigma, cosine()}), 1, few_ulp,
                         out[0] = oren_nayar_albedo(in[0], in[1])),
        CHECKED_FUNCTION("oren_nayar_mean_albedo", "kernels/scatter/oren_nayar.h",
                         (Arguments{sigma}), 1, few_ulp, out[0] = oren_nayar_mean_albedo(in[0])),
    };
}

std::vector<CheckedFunction> medium_functions() {
    const Argument deflection{
        Argument::Kind::Uniform, -1.0, 1.0, {-1.0f, 0.0f, 0.5f, 0.9999f, 0.9999999f, 1.0f}};
    const Argument anisotropy{
        Argument::Kind::Uniform, -0.999, 0.9999, {-0.99f, 0.0f, 0.5f, 0.99f, 0.999f, 0.9999f}};
    return {
        CHECKED_FUNCTION("henyey_greenstein_phase", "kernels/scatter/henyey_greenstein.h",
                         (Arguments{anisotropy, deflection}), 1,
                         (Accuracy{1e-5, 1e-6, "1 - g and 1 - cos are formed once, exactly"}),
                         out[0] = henyey_greenstein_phase(in[0], in[1])),
            CHECKED_FUNCTION("henyey_greenstein_sample", "kernels/scatter/henyey_greenstein.h",
                             (Arguments{any_direction(), anisotropy, unit(), unit()}), 3,
                             (Accuracy{1e-4, 1.0, "components of a unit vector, the sine a root"}),
                             const Vec3 w =
                                 henyey_greenstein_sample(CHECK_VECTOR(0), in[3], in[4], in[5]);
                             CHECK_RESULT(0, w)),
    };
}

// D, Lambda, G, value, sampling and density of one distribution. A facet is given by its slopes in
// units of alpha; the second direction is the first one's mirror image in it.
#define MICROFACET_FUNCTIONS(distribution, label, least, most)                                     \
    CHECKED_FUNCTION("microfacet_d " label, "kernels/scatter/microfacet.h",                        \
                     (Arguments{roughness(least, most), slope(), slope()}), 1, lobe,               \
                     const Vec3 h = vec3_normalise(vec3(in[0] * in[1], in[0] * in[2], REAL(1.0))); \
                     out[0] = microfacet_d(distribution, in[0], h)),                               \
        CHECKED_FUNCTION(                                                                          \
            "microfacet_g2 " label, "kernels/scatter/microfacet.h",                                \
            (Arguments{roughness(least, most), direction(), direction()}), 2,                      \
            (Accuracy{5e-6, 1e-6, "bounded by 1, smooth"}), const Vec3 wi = CHECK_VECTOR(1);       \
            const Vec3 wo = CHECK_VECTOR(4); const Vec3 h = vec3_normalise(vec3_add(wi, wo));      \
            out[0] = microfacet_g2(distribution, in[0], wi, wo, h);                                \
            out[1] = microfacet_g2_over_cosines(distribution, in[0], wi, wo, h)),                  \
        CHECKED_FUNCTION("microfacet_reflection " label, "kernels/scatter/microfacet.h",           \
                         (Arguments{roughness(usual_alpha, most), slope(), slope(), direction()}), \
                         2, narrow_lobe(), const Vec3 wo = CHECK_VECTOR(3);                        \
                         const Vec3 h =                                                            \
                             vec3_normalise(vec3(in[0] * in[1], in[0] * in[2], REAL(1.0)));        \
                         const Vec3 wi = vec3_sub(vec3_scale(h, REAL(2.0) * vec3_dot(wo, h)), wo); \
                         out[0] = microfacet_reflection(distribution, in[0], wi, wo);              \
                         out[1] = microfacet_reflection_cos(distribution, in[0], wi, wo)),         \
        CHECKED_FUNCTION(                                                                          \
            "microfacet_pdf " label, "kernels/scatter/microfacet.h",                               \
            (Arguments{roughness(least, most), slope(), slope(), direction()}), 1, lobe,           \
            const Vec3 h = vec3_normalise(vec3(in[0] * in[1], in[0] * in[2], REAL(1.0)));          \
            out[0] = microfacet_pdf(distribution, in[0], CHECK_VECTOR(3), h)),                     \
        CHECKED_FUNCTION(                                                                          \
            "microfacet_sample " label, "kernels/scatter/microfacet.h",                            \
            (Arguments{roughness(least, most), direction(), unit(), unit()}), 3,                   \
            (Accuracy{1e-5, 1.0, "components of a unit vector"}),                                  \
            const Vec3 h = microfacet_sample(distribution, in[0], CHECK_VECTOR(1), in[4], in[5]);  \
            CHECK_RESULT(0, h))

/// Random values from `least`, hard ones as they are up to `most`.
Argument roughness(double least, double most) {
    Argument argument = alpha();
    argument.from = least;
    argument.to = most;
    std::erase_if(argument.hard, [&](float a) { return a > static_cast<float>(most); });
    return argument;
}

/// The half vector of two given directions is wrong by a rounding, which the lobe's slope, about
/// 4 / alpha, magnifies: far narrower lobes are among the hard values only.
constexpr double usual_alpha = 0.02;
Accuracy narrow_lobe() {
    return {1e-5 / usual_alpha, 1e-4, "a rounding of the half vector times the lobe's slope"};
}

std::vector<CheckedFunction> microfacet_functions() {
    return {
        MICROFACET_FUNCTIONS(MICROFACET_GGX, "ggx", 1e-4, 1.0),
        MICROFACET_FUNCTIONS(MICROFACET_BECKMANN, "beckmann", 1e-4, 1.0),
        MICROFACET_FUNCTIONS(MICROFACET_BLINN, "blinn", 1e-4, 0.99),
        CHECKED_FUNCTION("microfacet_lambda_cos ggx", "kernels/scatter/microfacet.h",
                         (Arguments{alpha(), direction()}), 1, few_ulp,
                         out[0] = microfacet_lambda_cos(MICROFACET_GGX, in[0], CHECK_VECTOR(1))),
        CHECKED_FUNCTION(
            "microfacet_lambda_cos beckmann", "kernels/scatter/microfacet.h",
            (Arguments{alpha(), direction()}), 1,
            (Accuracy{1e-5, 1e-2, "a difference; stands beside the cosine, never alone"}),
            out[0] = microfacet_lambda_cos(MICROFACET_BECKMANN, in[0], CHECK_VECTOR(1))),
        CHECKED_FUNCTION("microfacet_erfinv", "kernels/scatter/microfacet.h",
                         (Arguments{between(-1.0, 1.0)}), 1,
                         (Accuracy{1e-6, 1.0, "a polynomial in a logarithm"}),
                         out[0] = microfacet_erfinv(in[0])),
    };
}

void append(std::vector<CheckedFunction>& all, std::vector<CheckedFunction> some) {
    all.insert(all.end(), some.begin(), some.end());
}

} // namespace

std::vector<CheckedFunction> interface_functions() {
    std::vector<CheckedFunction> all = fresnel_functions();
    append(all, film_functions());
    append(all, oren_nayar_functions());
    append(all, medium_functions());
    append(all, microfacet_functions());
    return all;
}

} // namespace reradiant
