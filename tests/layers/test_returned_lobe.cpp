// Light that comes back from beneath rough interfaces: adding's lobes against the walk, direction
// by direction.
#include "tests/layers/dyed_balance.h"
#include "tests/layers/walk_parts.h"
#include "tests/support/directions.h"
#include "tests/support/private_cache.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace reradiant;
using namespace reradiant::test;

namespace {

const PrivateCache cache("returned_lobe");

struct Coat {
    std::string name;
    LayerStack stack; ///< over black
};

std::vector<Coat> coats() {
    using enum Distribution;
    return {
        {"rough over smooth", {{plain_layer(1.3, 0.3, Ggx), plain_layer(1.8, 0.0, Ggx)}, {}}},
        {"smooth over rough", {{plain_layer(1.5, 0.0, Ggx), plain_layer(1.9, 0.3, Ggx)}, {}}},
        {"rough over rough", {{plain_layer(1.5, 0.3, Ggx, 0.2), plain_layer(1.9, 0.2, Ggx)}, {}}},
        {"beckmann over ggx", {{plain_layer(1.4, 0.2, Beckmann), plain_layer(1.7, 0.3, Ggx)}, {}}},
        {"sheet", {{plain_layer(1.5, 0.3, Ggx)}, LowerFace{.alpha = 0.2}}},
    };
}

constexpr double thetas[] = {0.0, 45.0, 75.0}, phis[] = {0.0, 60.0, 180.0};

void expect_as_walked(const Coat& coat, double theta_i) {
    const kernels::Vec3 wi = direction_deg(theta_i);
    std::vector<kernels::Vec3> directions{kernels::vec3(-wi.x, -wi.y, wi.z)};
    for (const double theta : thetas)
        for (const double phi : phis)
            directions.push_back(direction_deg(theta, phi));
    const LayeredBsdf bsdf = adding_of(coat.stack);
    const WalkEstimate found =
        estimate_walk(walk_of(coat.stack), wi, directions, samples(16384), 3);
    const double mirrored = found.mean.directional[0].specular(0);
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const double adding = bsdf.parts(wi, directions[k]).specular(0);
        const double mean = found.mean.directional[k].specular(0);
        const double error = 4.0 * found.standard_error.directional[k].specular(0);
        // the table is linear between its nodes, and its walks have noise where there is little
        // light
        EXPECT_NEAR(adding, mean, 0.08 * mean + 0.01 * mirrored + error)
            << coat.name << ", " << theta_i << " degrees to " << k;
    }
}

void expect_reciprocal(const Coat& coat) {
    const LayeredBsdf bsdf = adding_of(coat.stack);
    const kernels::Vec3 a = direction_deg(35.0), b = direction_deg(60.0, 130.0);
    const double there = bsdf.eval(a, b)(0, 0), back = bsdf.eval(b, a)(0, 0);
    EXPECT_GT(there, 0.0) << coat.name;
    EXPECT_NEAR(there, back, 1e-12 * there) << coat.name;
}

} // namespace

// Tables take a second each to make: one test asks for all that there is to know of a stack.
TEST(ReturnedLobe, IsThatOfTheWalk) {
    for (const Coat& coat : coats()) {
        for (const double theta_i : thetas)
            expect_as_walked(coat, theta_i);
        expect_reciprocal(coat);
    }
}
