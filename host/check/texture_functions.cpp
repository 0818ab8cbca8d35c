#include "host/check/checked_function.h"

#include "kernels/core/random.h"
#include "kernels/core/sampling.h"
#include "kernels/core/table.h"
#include "kernels/core/wavelength.h"
#include "kernels/scene/texture.h"

namespace reradiant {

namespace {

const Accuracy exact{0.0, 1.0, "whole numbers and fractions of 24 bits have no rounding", 0.0};
const Accuracy unit_vector{2e-6, 1.0, "components of a unit vector"};
/// A point at 8 has steps of 5e-7, and noise changes by 2 over one.
const Accuracy of_place{1e-5, 1.0, "what a texture has lost of its place"};

std::vector<CheckedFunction> random_functions() {
    const Argument counter = integer(1 << 24);
    return {
        CHECKED_FUNCTION(
            "random_4", "kernels/core/random.h", (Arguments{counter, counter, counter, counter}), 4,
            exact, const Random4 r = random_4((uint)in[0], (uint)in[1], (uint)in[2], (uint)in[3]);
            out[0] = r.a; out[1] = r.b; out[2] = r.c; out[3] = r.d),
            CHECKED_FUNCTION("random_hash", "kernels/core/random.h", (Arguments{counter, counter}),
                             1, exact, out[0] = random_unit(random_hash((uint)in[0], (uint)in[1]))),
            CHECKED_FUNCTION("random_unit", "kernels/core/random.h", (Arguments{counter}), 1, exact,
                             out[0] = random_unit((uint)in[0] * 256u + 255u)),
            CHECKED_FUNCTION("wavelength_phases", "kernels/core/wavelength.h",
                             (Arguments{counter, counter, integer(6), counter}), 1, exact,
                             out[0] = (real)wavelength_phases((uint)in[0], (uint)in[1],
                                                              1u << (uint)in[2], (uint)in[3])),
    };
}

std::vector<CheckedFunction> sampling_functions() {
    return {
        CHECKED_FUNCTION("sampling_frame", "kernels/core/sampling.h",
                         (Arguments{any_direction(), direction()}), 6,
                         (Accuracy{1e-5, 1.0, "1 / (1 + |z|) is never more than 1"}),
                         const Frame frame = sampling_frame(CHECK_VECTOR(0));
                         const Vec3 world = sampling_to_world(frame, CHECK_VECTOR(3));
                         const Vec3 own = sampling_to_local(frame, CHECK_VECTOR(3));
                         CHECK_RESULT(0, world); CHECK_RESULT(3, own)),
            CHECKED_FUNCTION("sampling_circle", "kernels/core/sampling.h", (Arguments{unit()}), 3,
                             unit_vector, const Vec3 p = sampling_circle(in[0]);
                             CHECK_RESULT(0, p)),
            CHECKED_FUNCTION("sampling_disk", "kernels/core/sampling.h",
                             (Arguments{unit(), unit()}), 3, unit_vector,
                             const Vec3 p = sampling_disk(in[0], in[1]);
                             CHECK_RESULT(0, p)),
            CHECKED_FUNCTION("sampling_cosine", "kernels/core/sampling.h",
                             (Arguments{unit(), unit()}), 3, unit_vector,
                             const Vec3 p = sampling_cosine(in[0], in[1]);
                             CHECK_RESULT(0, p)),
            CHECKED_FUNCTION("table_stencil", "kernels/core/table.h", (Arguments{cosine()}), 2,
                             (Accuracy{2e-5, 1.0, "the place among 64 steps has lost 6 bits"}),
                             const TableStencil s = table_stencil(in[0]);
                             out[0] = s.w0 + s.w1 + s.w2 + s.w3;
                             out[1] = (real)s.node + s.w1 + REAL(2.0) * s.w2 + REAL(3.0) * s.w3),
            CHECKED_FUNCTION("table_search", "kernels/core/table.h",
                             (Arguments{integer(64), unit()}), 1, exact,
                             out[0] = (real)table_search(tables->shift + (uint)in[0] * LANES,
                                                         LANES - 1u, 1u, in[1])),
    };
}

std::vector<CheckedFunction> place_functions() {
    const Argument place{Argument::Kind::Uniform, -8.0, 8.0, {0.0f, 0.5f, -0.25f, 7.9f}};
    const Argument part{Argument::Kind::Uniform, 0.0, 1.0, {0.0f, 0.03125f, 0.5f, 1.0f}};
    const Arguments point{place, place, place, part, part};
    return {
        CHECKED_FUNCTION("texture_gradient_noise", "kernels/scene/texture.h",
                         (Arguments{place, place, place}), 1, of_place,
                         out[0] = texture_gradient_noise(CHECK_VECTOR(0), 7u)),
            CHECKED_FUNCTION("texture_at noise", "kernels/scene/texture.h", point, 3, of_place,
                             const TexturePoint t = texture_at(tables->textures[0], CHECK_VECTOR(0),
                                                               in[3], in[4], tables->image);
                             out[0] = t.value; out[1] = t.slope_x; out[2] = t.slope_y),
            CHECKED_FUNCTION("texture_at voronoi", "kernels/scene/texture.h", point, 3,
                             (Accuracy{1e-5, 1.0, "a flake's own numbers", 1e-2}),
                             const TexturePoint t = texture_at(tables->textures[1], CHECK_VECTOR(0),
                                                               in[3], in[4], tables->image);
                             out[0] = t.value; out[1] = t.slope_x; out[2] = t.slope_y),
            CHECKED_FUNCTION("texture_at checker", "kernels/scene/texture.h", point, 1,
                             (Accuracy{0.0, 1.0, "one of two values", 1e-2}),
                             const TexturePoint t = texture_at(tables->textures[2], CHECK_VECTOR(0),
                                                               in[3], in[4], tables->image);
                             out[0] = t.value),
            CHECKED_FUNCTION("texture_at image", "kernels/scene/texture.h", point, 4, of_place,
                             const TexturePoint t = texture_at(tables->textures[3], CHECK_VECTOR(0),
                                                               in[3], in[4], tables->image);
                             out[0] = t.value; out[1] = t.red; out[2] = t.green; out[3] = t.blue),
            CHECKED_FUNCTION("texture_level", "kernels/scene/texture.h",
                             (Arguments{part, integer(15), unit()}), 1,
                             (Accuracy{0.0, 1.0, "a choice between two levels", 1e-3}),
                             out[0] = (real)texture_level(in[0], (uint)in[1] + 2u, in[2])),
    };
}

} // namespace

std::vector<CheckedFunction> texture_functions() {
    std::vector<CheckedFunction> all = random_functions();
    for (const auto& some : {sampling_functions(), place_functions()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

} // namespace reradiant
