// Adding in double precision over random stacks: shares stay shares, and light is not made.
#include "tests/layers/layer_values.h"
#include "tests/support/full_run.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <random>

using namespace reradiant;

namespace {

const test::PrivateCache cache("random-stacks");

using Engine = std::mt19937_64;

double uniform(Engine& engine, double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine);
}
template <std::size_t N>
double one_of(Engine& engine, const double (&values)[N]) {
    return values[std::uniform_int_distribution<std::size_t>(0, N - 1)(engine)];
}

double random_tau(Engine& engine) {
    constexpr double edges[] = {0.0, 0.0, 1e-8, 1e-3, 104.0, 1e4};
    return uniform(engine, 0, 1) < 0.5 ? one_of(engine, edges) : uniform(engine, 0.0, 3.0);
}

StackValues smooth_stack(Engine& engine) {
    constexpr double edges[] = {1.0, 1.0 + 1e-6, 1.0 - 1e-6, 1.0001, 4.0};
    const bool many = uniform(engine, 0, 1) < 0.01;
    StackValues stack(many ? 64 : std::uniform_int_distribution<std::size_t>(1, 6)(engine));
    for (LayerValues& layer : stack) {
        layer.ior = uniform(engine, 0, 1) < 0.3 ? one_of(engine, edges) : uniform(engine, 1.0, 4.0);
        layer.tau = random_tau(engine);
    }
    return stack;
}

/// Some of few interfaces, whose operators are then computed once each.
StackValues rough_stack(Engine& engine) {
    constexpr double iors[] = {1.0, 1.3, 1.5, 2.0}, alphas[] = {0.0, 0.1, 0.6};
    StackValues stack(std::uniform_int_distribution<std::size_t>(1, 3)(engine));
    for (LayerValues& layer : stack) {
        layer.ior = one_of(engine, iors);
        layer.alpha = one_of(engine, alphas);
        layer.tau = random_tau(engine);
        layer.distribution =
            uniform(engine, 0, 1) < 0.5 ? Distribution::Ggx : Distribution::Beckmann;
    }
    return stack;
}

/// Returns the cosine of an angle from the normal to 89.9999 degrees.
double random_cosine(Engine& engine) {
    return uniform(engine, 0, 1) < 0.3 ? std::pow(10.0, uniform(engine, -6.0, 0.0))
                                       : uniform(engine, 0.0, 1.0);
}

/// The first thing wrong, or nothing. What arrives at the substrate and what never does are parts
/// of the light that came; the rest is absorbed.
std::string fault(const StackModel& t, Engine& engine, int directions) {
    const double r = t.internal_reflectance();
    if (!(r >= 0.0 && r < 1.0 + 1e-12))
        return "r = " + std::to_string(r);
    for (int i = 0; i < directions; ++i) {
        const double c = random_cosine(engine);
        const double down = t.transmission(c), back = t.specular_albedo(c);
        if (!(down >= 0.0 && back >= 0.0 && down + back <= 1.0 + 1e-9))
            return "T " + std::to_string(down) + ", R " + std::to_string(back) + " at cos " +
                   std::to_string(c);
        if (!(t.specular_delta(c) >= 0.0 && t.residual(c) >= 0.0 && t.residual_average() >= 0.0))
            return "a negative part at cos " + std::to_string(c);
    }
    return "";
}

template <typename MakeStack>
void expect_sound(std::size_t count, int directions, MakeStack make) {
    std::atomic<int> faults = 0;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        Engine engine(i);
        const StackValues stack = make(engine);
        const std::string what = fault(*adding_transport(stack), engine, directions);
        if (!what.empty() && ++faults <= 5) // more would only repeat
            ADD_FAILURE() << "stack " << i << " of " << stack.size() << " layers: " << what;
    });
    EXPECT_EQ(faults, 0);
}

} // namespace

TEST(RandomStacks, SmoothOnesConserveEnergyAtEveryAngle) {
    expect_sound(test::is_full_run() ? 1000000 : 20000, test::is_full_run() ? 20 : 10,
                 smooth_stack);
}

TEST(RandomStacks, SmoothCoatOverARoughOneMakesNoLight) {
    // number 1232 of the test below: fits of shares whose sum is 1 came to 1 + 2e-9
    StackValues stack(2);
    stack[0].ior = 1.3;
    stack[1].ior = 1.5;
    stack[1].alpha = 0.6;
    stack[1].distribution = Distribution::Beckmann;
    const auto transport = adding_transport(stack);
    for (int i = 0; i <= 1000; ++i) {
        const double c = i / 1000.0;
        EXPECT_LE(transport->transmission(c) + transport->specular_albedo(c), 1.0 + 1e-13) << c;
    }
}

TEST(RandomStacks, RoughOnesConserveEnergyAtEveryAngle) {
    expect_sound(test::is_full_run() ? 2000 : 6, 500, rough_stack);
}
