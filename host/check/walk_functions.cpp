#include "host/check/checked_function.h"

#include "kernels/walk/walk_interface.h"

namespace reradiant {

namespace {

/// A view from between the facets may come from a little below the horizon.
Argument view() {
    Argument argument = direction();
    argument.hard.insert(argument.hard.end(), {0.9949874f, 0.0f, -0.1f});
    return argument;
}

Argument height() {
    return {Argument::Kind::Uniform, 1e-6, 0.9999999, {1e-6f, 0.5f, 0.9999999f}};
}

Argument walk_alpha() {
    return {Argument::Kind::Logarithmic, 0.01, 1.0, {0.01f, 0.1f, 0.5f, 1.0f}};
}

/// Distribution (blinn has no heights), alpha and IOR ratio of CHECK_SURFACE.
#define SMITH integer(2), walk_alpha(), ior()

const Accuracy density{1e-3, 1e-2, "half vector's rounding times the slope of a lobe, alpha 0.01",
                       5e-3};

std::vector<CheckedFunction> facet_functions() {
    return {
        CHECKED_FUNCTION("walk_visible_area", "kernels/walk/walk_facets.h",
                         (Arguments{SMITH, view()}), 1,
                         (Accuracy{1e-4, 1e-3, "beckmann's is a difference below the horizon"}),
                         const WalkSurface surface = CHECK_SURFACE;
                         out[0] = walk_visible_area(surface, CHECK_VECTOR(3))),
            CHECKED_FUNCTION("walk_refracted", "kernels/walk/walk_facets.h",
                             (Arguments{ior(), direction(), direction()}), 3,
                             (Accuracy{1e-4, 1.0, "the root at the critical angle"}),
                             const Vec3 w = walk_refracted(CHECK_VECTOR(1), CHECK_VECTOR(4), in[0]);
                             CHECK_RESULT(0, w)),
            CHECKED_FUNCTION("walk_reflection_density", "kernels/walk/walk_facets.h",
                             (Arguments{SMITH, direction(), direction(), unit()}), 1, density,
                             const WalkSurface surface = CHECK_SURFACE;
                             const Vec3 h = walk_half_reflected(CHECK_VECTOR(3), CHECK_VECTOR(6));
                             out[0] = walk_reflection_density(surface, CHECK_VECTOR(3), h, in[9])),
            CHECKED_FUNCTION("walk_refraction_density", "kernels/walk/walk_facets.h",
                             (Arguments{SMITH, direction(), direction(), unit()}), 1, density,
                             const WalkSurface surface = CHECK_SURFACE;
                             const WalkRefraction r = walk_refraction(
                                 surface, CHECK_VECTOR(3), walk_mirrored(CHECK_VECTOR(6)));
                             out[0] = walk_refraction_density(surface, CHECK_VECTOR(3), r, in[9])),
            CHECKED_FUNCTION(
                "walk_drawn_share", "kernels/walk/walk_facets.h",
                (Arguments{integer(3), walk_alpha(), ior(), direction(), unit(), unit()}), 1,
                (Accuracy{1e-3, 1e-2, "a facet's rounding over cosines at grazing views", 5e-3}),
                const WalkSurface surface = {(int)in[0], in[1], in[2], 1, 0, 0};
                const Vec3 v = CHECK_VECTOR(3);
                const Vec3 h = microfacet_sample(surface.distribution, in[1], v, in[6], in[7]);
                const Vec3 w = walk_reflected(v, h);
                out[0] = w.z > REAL(0.0) && vec3_dot(v, h) > REAL(0.0)
                             ? walk_drawn_share(surface, v, h, w, vec3_dot(v, h))
                             : REAL(0.0)),
            CHECKED_FUNCTION(
                "walk_escape", "kernels/walk/walk_microsurface.h",
                (Arguments{SMITH, direction(), height()}), 1,
                (Accuracy{1e-5, 1e-2, "an exponent that is large where little escapes"}),
                const WalkSurface surface = CHECK_SURFACE;
                out[0] = walk_escape(surface, CHECK_VECTOR(3), in[6])),
            CHECKED_FUNCTION(
                "walk_next_height", "kernels/walk/walk_microsurface.h",
                (Arguments{SMITH, any_direction(), height(), unit()}), 1,
                (Accuracy{1e-4, 1e-2, "a quotient by Lambda, beckmann's a difference"}),
                const WalkSurface surface = CHECK_SURFACE;
                out[0] = walk_next_height(surface, CHECK_VECTOR(3), in[6], in[7])),
            CHECKED_FUNCTION(
                "walk_met_height", "kernels/walk/walk_microsurface.h",
                (Arguments{SMITH, any_direction(), height(), unit()}), 1,
                (Accuracy{1e-4, 1e-2, "a quotient by Lambda, beckmann's a difference"}),
                const WalkSurface surface = CHECK_SURFACE;
                out[0] = walk_met_height(surface, CHECK_VECTOR(3), in[6], in[7])),
    };
}

#define WALK_INTERFACE(label, least_distribution, alpha_factor, multiple, accuracy)                \
    CHECKED_FUNCTION(                                                                              \
        "walk_interface " label, "kernels/walk/walk_interface.h",                                  \
        (Arguments{integer(3 - (least_distribution)), walk_alpha(), ior(), direction(),            \
                   direction(), direction(), integer(1 << 24)}),                                   \
        7, accuracy,                                                                               \
        const WalkSurface surface = {(int)in[0] + (least_distribution),                            \
                                     in[1] * (real)(alpha_factor), in[2], multiple, 0, 0};         \
        const WalkTargets targets = {CHECK_VECTOR(6), CHECK_VECTOR(9), 1, 1};                      \
        WalkRandom random = walk_random((uint)in[12], 3u, 5u, 7u);                                 \
        const WalkDeparture d = walk_interface(surface, CHECK_VECTOR(3), targets, &random);        \
        CHECK_RESULT(0, d.direction); out[3] = (real)d.passed; out[4] = d.weight;                  \
        out[5] = d.same_density; out[6] = d.beyond_density)

std::vector<CheckedFunction> crossing_functions() {
    return {
        WALK_INTERFACE("smooth", 0, 0, 0,
                       (Accuracy{1e-4, 1.0, "the root at the critical angle", 5e-3})),
        WALK_INTERFACE("single", 0, 1, 0,
                       (Accuracy{1e-3, 1.0, "densities over lobes of alpha 0.01", 1e-2})),
        WALK_INTERFACE("multiple", 1, 1, 1,
                       (Accuracy{1e-2, 1.0, "every facet magnifies the roundings before", 2e-2})),
    };
}

} // namespace

std::vector<CheckedFunction> walk_functions() {
    std::vector<CheckedFunction> all = facet_functions();
    for (const CheckedFunction& function : crossing_functions())
        all.push_back(function);
    return all;
}

} // namespace reradiant
