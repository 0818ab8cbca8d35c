#include "host/check/checked_function.h"

#include "kernels/scene/camera.h"
#include "kernels/scene/cone_lights.h"
#include "kernels/scene/environment.h"
#include "kernels/scene/lights.h"
#include "kernels/scene/shaped_lights.h"

namespace reradiant {

namespace {

const Accuracy few_ulp{3e-6, 1e-30, "quotients of sums without cancellation"};
/// Points lie 0.1 and more from the lights.
const Accuracy light_sample{1e-4, 1e-3, "cosine at the light and miss of a sphere cancel"};
const Accuracy unit_vector{5e-6, 1.0, "components of a unit vector"};

Argument place(double size) {
    const auto edge = static_cast<float>(size);
    return {Argument::Kind::Uniform, -size, size, {0.0f, 0.5f * edge, -edge}};
}

#define LIGHT_SAMPLE(index, label)                                                                 \
    CHECKED_FUNCTION(                                                                              \
        "lights_sample " label, "kernels/scene/lights.h",                                          \
        (Arguments{place(4.0), place(1.5), place(4.0), unit(), unit()}), 6, light_sample,          \
        const LightSample s = lights_sample(tables->lights[index], CHECK_VECTOR(0), in[3], in[4]); \
        out[0] = s.weight; out[1] = s.pdf; out[2] = s.distance; CHECK_RESULT(3, s.direction))

std::vector<CheckedFunction> lamp_functions() {
    const Argument length{Argument::Kind::Logarithmic, 1e-3, 1e3, {1e-3f, 1.0f, 1e3f}};
    const Argument pdf{Argument::Kind::Logarithmic, 1e-6, 1e12, {0.0f, 1e-30f, 1.0f, 1e18f}};
    return {
        LIGHT_SAMPLE(0, "rectangle"), LIGHT_SAMPLE(1, "sphere"), LIGHT_SAMPLE(2, "point"),
            LIGHT_SAMPLE(3, "directional"),
            CHECKED_FUNCTION("lights_choose", "kernels/scene/lights.h", (Arguments{unit()}), 1,
                             (Accuracy{0.0, 1.0, "a whole number", 0.0}),
                             out[0] = (real)lights_choose(tables->lights, CHECK_LIGHTS, in[0])),
            CHECKED_FUNCTION("lights_rectangle_pdf", "kernels/scene/lights.h",
                             (Arguments{length, length, cosine()}), 1, few_ulp,
                             out[0] = lights_rectangle_pdf(in[0], in[1], in[2])),
            CHECKED_FUNCTION("lights_sphere_cone", "kernels/scene/lights.h",
                             (Arguments{length, length}), 1,
                             (Accuracy{1e-5, 1e-30, "a root near the sphere's own surface"}),
                             out[0] = lights_sphere_cone(in[0], in[1])),
            CHECKED_FUNCTION("lights_pdf", "kernels/scene/lights.h",
                             (Arguments{place(4.0), place(1.5), place(4.0), length, cosine()}), 2,
                             (Accuracy{1e-5, 1e-30, "as the cone and the rectangle"}),
                             out[0] = lights_pdf(tables->lights[0], CHECK_VECTOR(0), in[3], in[4]);
                             out[1] = lights_pdf(tables->lights[1], CHECK_VECTOR(0), in[3], in[4])),
            CHECKED_FUNCTION("lights_mis_weight", "kernels/scene/lights.h", (Arguments{pdf, pdf}),
                             1, few_ulp, out[0] = lights_mis_weight(in[0], in[1])),
    };
}

#define LAMP_SAMPLE(label, file, arguments, sampled)                                               \
    CHECKED_FUNCTION(label, file, (arguments), 6, light_sample, const LightSample s = sampled;     \
                     out[0] = s.weight; out[1] = s.pdf; out[2] = s.distance;                       \
                     CHECK_RESULT(3, s.direction))

std::vector<CheckedFunction> other_lamp_functions() {
    const Arguments above{place(4.0), place(1.5), place(4.0), unit(), unit()};
    return {
        LAMP_SAMPLE("shaped_lights_sample disk", "kernels/scene/shaped_lights.h", above,
                    shaped_lights_sample(tables->lamps[0], tables->triangles, CHECK_VECTOR(0),
                                         in[3], in[4])),
            LAMP_SAMPLE("shaped_lights_sample mesh", "kernels/scene/shaped_lights.h", above,
                        shaped_lights_sample(tables->lamps[1], tables->triangles, CHECK_VECTOR(0),
                                             in[3], in[4])),
            LAMP_SAMPLE("cone_lights_spot", "kernels/scene/cone_lights.h", above,
                        cone_lights_spot(tables->lamps[2], CHECK_VECTOR(0))),
            CHECKED_FUNCTION("cone_lights_distant", "kernels/scene/cone_lights.h",
                             (Arguments{unit(), unit()}), 3, unit_vector,
                             const LightSample s =
                                 cone_lights_distant(tables->lamps[3], in[0], in[1]);
                             CHECK_RESULT(0, s.direction)),
    };
}

std::vector<CheckedFunction> sky_functions() {
    return {
        CHECKED_FUNCTION(
            "environment_place", "kernels/scene/environment.h", (Arguments{any_direction()}), 3,
            (Accuracy{1e-6, 1.0, "angles over a turn"}),
            const EnvironmentPlace p = environment_place(tables->environment, CHECK_VECTOR(0));
            out[0] = p.u; out[1] = p.v; out[2] = p.sin_theta),
            CHECKED_FUNCTION(
                "environment_pdf", "kernels/scene/environment.h", (Arguments{any_direction()}), 1,
                (Accuracy{1e-5, 1e-3, "one texel's density", 1e-2}),
                out[0] = environment_pdf(tables->environment, tables->image,
                                         environment_place(tables->environment, CHECK_VECTOR(0)))),
            CHECKED_FUNCTION(
                "environment_sample", "kernels/scene/environment.h", (Arguments{unit(), unit()}), 3,
                (Accuracy{2e-4, 1.0, "a place in a row that is picked with 1 % keeps 17 bits"}),
                const Vec3 w = environment_sample(tables->environment, tables->image, in[0], in[1]);
                CHECK_RESULT(0, w)),
            CHECKED_FUNCTION(
                "environment_colour", "kernels/scene/environment.h", (Arguments{any_direction()}),
                3, (Accuracy{1e-5, 1.0, "the place among the texels"}),
                const EnvironmentPlace p = environment_place(tables->environment, CHECK_VECTOR(0));
                out[0] = environment_colour(tables->environment, tables->image, p, 0u);
                out[1] = environment_colour(tables->environment, tables->image, p, 1u);
                out[2] = environment_colour(tables->environment, tables->image, p, 2u)),
    };
}

std::vector<CheckedFunction> camera_functions() {
    const Argument column{Argument::Kind::Uniform, 0.0, 640.0, {0.0f, 0.5f, 320.0f, 640.0f}};
    const Argument row{Argument::Kind::Uniform, 0.0, 360.0, {0.0f, 0.5f, 180.0f, 360.0f}};
    return {
        CHECKED_FUNCTION("camera_ray", "kernels/scene/camera.h",
                         (Arguments{column, row, unit(), unit()}), 6, unit_vector,
                         const CameraRay ray =
                             camera_ray(tables->camera, in[0], in[1], in[2], in[3]);
                         CHECK_RESULT(0, ray.origin); CHECK_RESULT(3, ray.direction))
    };
}

} // namespace

std::vector<CheckedFunction> light_functions() {
    std::vector<CheckedFunction> all = lamp_functions();
    for (const auto& some : {other_lamp_functions(), sky_functions(), camera_functions()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

} // namespace reradiant
