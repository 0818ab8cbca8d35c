#include "host/check/checked_function.h"

#include <algorithm>

namespace reradiant {

namespace {

using tracked::real;
using tracked::uint;

const Accuracy sum{5e-6, 1e-6, "sums of positive numbers"};
const Accuracy exact{0.0, 1.0, "a whole number", 0.0};

/// Lanes whose results are looked at: both ends, and beside the ends of vectors.
constexpr uint seen[] = {0, 15, 16, 40, 63};
constexpr std::size_t seen_count = std::size(seen);

/// Radiance of a lane, from eight numbers.
Arguments radiances() {
    return Arguments(8, between(0.0, 2.0));
}

#define LANES_IN                                                                                   \
    "float16 down[CHUNKS], up[CHUNKS]; "                                                           \
    "for (uint l = 0u; l < LANES; ++l) ((float*)down)[l] = in[l & 7u]; "                           \
    "for (uint c = 0u; c < CHUNKS; ++c) up[c] = (float16)(0.0f); "
#define LANES_OUT(values)                                                                          \
    "out[0] = ((float*)" values ")[0]; out[1] = ((float*)" values                                  \
    ")[15]; out[2] = ((float*)" values ")[16]; out[3] = ((float*)" values                          \
    ")[40]; out[4] = ((float*)" values ")[63]; "

/// sum over k of e_k[o] * sum over i < o of x_k[i] in[i]
real factored(const real* in, const CheckTables* tables, uint o) {
    real result = 0.0;
    for (uint k = 0; k < CHECK_RANK; ++k) {
        real excited = 0.0;
        for (uint i = 0; i < o; ++i)
            excited += tables->factors[(CHECK_RANK + k) * LANES + i] * in[i & 7U];
        result += tables->factors[k * LANES + o] * excited;
    }
    return result;
}

real dense(const real* in, const CheckTables* tables, uint o) {
    real result = 0.0;
    for (uint i = 0; i < LANES; ++i)
        result += tables->dense[i * LANES + o] * in[i & 7U];
    return result;
}

std::vector<CheckedFunction> reradiation_functions() {
    return {
        CHECKED_ON_DEVICE(
            "reradiation_factored", "kernels/stack/reradiation.h", radiances(), seen_count, sum,
            LANES_IN
            "reradiation_factored(down, up, tables->factors, CHECK_RANK); " LANES_OUT("up"),
            for (std::size_t i = 0; i < seen_count; ++i) out[i] = factored(in, tables, seen[i])),
            CHECKED_ON_DEVICE(
                "reradiation_dense", "kernels/stack/reradiation.h", radiances(), seen_count, sum,
                LANES_IN "reradiation_dense(down, up, tables->dense); " LANES_OUT("up"),
                for (std::size_t i = 0; i < seen_count; ++i) out[i] = dense(in, tables, seen[i])),
    };
}

std::vector<CheckedFunction> film_functions() {
    return {
        CHECKED_ON_DEVICE("film_luminance", "kernels/film.cl", radiances(), 1, sum,
                          LANES_IN "out[0] = film_luminance(down, tables->factors);", out[0] = 0.0;
                          for (uint l = 0; l < LANES; ++l) out[0] +=
                          tables->factors[l] * in[l & 7U]),
            // every sign, exponent and first bits of a fraction
            CHECKED_ON_DEVICE(
                "film_not_finite", "kernels/film.cl", (Arguments{integer(1 << 16)}), 1, exact,
                "const float v = as_float((uint)in[0] << 16 | 1u); "
                "out[0] = any(film_not_finite((float16)(v))) ? 1.0f : 0.0f;",
                out[0] = ((static_cast<uint>(in[0].value) << 16U) & 0x7f800000U) == 0x7f800000U
                             ? 1.0
                             : 0.0),
    };
}

/// Returns what leaves at the `j`-th of four lanes for radiance that arrives at four lanes.
real shifted(const real* in, const CheckTables* tables, uint j) {
    constexpr uint to[] = {63, 40, 16, 0}, from[] = {0, 10, 20, 63};
    real result = 0.0;
    for (const uint i : from)
        for (uint r = 0; r < CHECK_RANK && i < to[j]; ++r)
            result += tables->factors[r * LANES + to[j]] *
                      (in[i & 7U] * tables->factors[(CHECK_RANK + r) * LANES + i]);
    return result;
}

uint searched(const CheckTables* tables, uint row, double u) {
    const float* const first = tables->shift + row * LANES;
    return static_cast<uint>(std::upper_bound(first, first + LANES - 1, u) - first);
}

std::vector<CheckedFunction> hero_functions() {
    return {
        CHECKED_ON_DEVICE("hero_rotated", "kernels/stack/hero.h", (Arguments{unit()}), 4,
                          (Accuracy{0.0, 1.0, "a whole number"}),
                          "const HeroLanes lanes = hero_rotated(in[0], 3u, 50u); "
                          "for (uint j = 0u; j < HERO; ++j) out[j] = (float)hero_lane(lanes, j);",
                          const uint first = std::min(static_cast<uint>(in[0] * 50.0), 49U);
                          for (uint j = 0; j < 4; ++j) out[j] = 3U + (first + j * 50U / 4U) % 50U),
            CHECKED_ON_DEVICE(
                "hero_search", "kernels/stack/hero.h", (Arguments{integer(64), unit()}), 2, exact,
                "const uint found = hero_search(tables->shift + (uint)in[0] * LANES, "
                "in[1]); out[0] = (float)found; "
                "out[1] = hero_probability(tables->shift + (uint)in[0] * LANES, 0u);",
                const auto row = static_cast<uint>(in[0]);
                out[0] = searched(tables, row, in[1].value); out[1] = tables->shift[row * LANES]),
            CHECKED_ON_DEVICE("hero_factored", "kernels/stack/hero.h", radiances(), 4, sum,
                              "const HeroLanes to = (HeroLanes)(63u, 40u, 16u, 0u), "
                              "from = (HeroLanes)(0u, 10u, 20u, 63u); "
                              "const Lanes value = hero_factored(to, from, (Lanes)(in[0], in[2], "
                              "in[4], in[7]), tables->factors, CHECK_RANK); "
                              "for (uint j = 0u; j < HERO; ++j) out[j] = ((float*)&value)[j];",
                              for (uint j = 0; j < 4; ++j) out[j] = shifted(in, tables, j)),
    };
}

} // namespace

std::vector<CheckedFunction> lane_functions() {
    std::vector<CheckedFunction> all = reradiation_functions();
    for (const auto& some : {film_functions(), hero_functions()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

} // namespace reradiant
