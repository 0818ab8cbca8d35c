// Light through sheets with rough faces: adding's lobe against the walk, direction by direction.
#include "host/layers/models/sheet_transmission.h"
#include "tests/layers/dyed_balance.h"
#include "tests/layers/walk_parts.h"
#include "tests/support/directions.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>

#include <fmt/core.h>

#include <string>
#include <vector>

using namespace reradiant;
using namespace reradiant::test;

namespace {

const PrivateCache cache("through_lobe");

struct Sheet {
    std::string name;
    LayerStack stack;
    bool has_long_tails = true;
};

std::vector<Sheet> sheets() {
    using enum Distribution;
    LayerStack laminated{{plain_layer(1.5, 0.25, Ggx), plain_layer(1.65, 0.0, Ggx)},
                         LowerFace{.alpha = 0.1}};
    return {
        {"ggx 0.3 and 0.2", {{plain_layer(1.5, 0.3, Ggx, 0.3)}, LowerFace{.alpha = 0.2}}},
        {"ggx 0.5 on both", {{plain_layer(1.5, 0.5, Ggx)}, LowerFace{.alpha = 0.5}}},
        {"frosted beneath", {{plain_layer(1.52, 0.0, Ggx)}, LowerFace{.alpha = 0.35}}},
        {"beckmann 0.2 above", {{plain_layer(1.4, 0.2, Beckmann)}, LowerFace{}}, false},
        {"laminated", laminated},
    };
}

/// Directions of light from above and of what is seen beneath; 180 is straight on.
constexpr double thetas[] = {0.0, 45.0, 75.0}, phis[] = {0.0, 60.0, 180.0};

/// Checks what an incident direction brings to all others.
void expect_as_walked(const Sheet& sheet, double theta_i) {
    const kernels::Vec3 wi = direction_deg(theta_i);
    std::vector<kernels::Vec3> directions{kernels::vec3(-wi.x, -wi.y, -wi.z)};
    for (const double theta : thetas)
        for (const double phi : phis)
            directions.push_back(direction_deg(180.0 - theta, phi));
    const LayeredBsdf bsdf = adding_of(sheet.stack);
    const WalkEstimate found =
        estimate_walk(walk_of(sheet.stack), wi, directions, samples(8192), 3);
    const double straight_on = all_light(found.mean.directional[0])(0, 0);
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const double adding = bsdf.eval(wi, directions[k])(0, 0);
        const double mean = all_light(found.mean.directional[k])(0, 0);
        const double error = 4.0 * all_errors(found.standard_error.directional[k])(0, 0);
        const std::string where = fmt::format("{}, {} degrees to {}", sheet.name, theta_i, k);
        // the table is linear between its nodes, and its walks have noise where there is little
        // light
        EXPECT_NEAR(adding, mean, 0.06 * mean + 0.01 * straight_on + error) << where;
        if (sheet.has_long_tails) {
            EXPECT_NEAR(adding, mean, 0.3 * mean + error) << where;
        }
    }
}

void expect_the_same_from_both_sides(const Sheet& sheet) {
    const LayeredBsdf bsdf = adding_of(sheet.stack);
    const kernels::Vec3 above = direction_deg(35.0), below = direction_deg(130.0, 100.0);
    const double down = bsdf.eval(above, below)(0, 0), up = bsdf.eval(below, above)(0, 0);
    EXPECT_GT(down, 0.0) << sheet.name;
    EXPECT_NEAR(down, up, 1e-12 * down) << sheet.name;
}

/// The lobe's amplitudes bring all light that goes through.
void expect_all_light(const Sheet& sheet) {
    const StackElements elements = stack_at(sheet.stack, 550.0);
    const SheetTransmission through(elements, through_lobe(std::span(&elements, 1)));
    for (const Side side : {Side::Above, Side::Below})
        for (const double c : {0.2, 0.6, 1.0}) {
            const double whole = through.specular_albedo(c, side);
            EXPECT_NEAR(through.lobe_albedo(c, side), whole, 0.02 * whole)
                << sheet.name << ", cosine " << c;
        }
}

} // namespace

// Tables take a second each to make: one test asks for all that there is to know of a sheet.
TEST(ThroughLobe, IsThatOfTheWalk) {
    for (const Sheet& sheet : sheets()) {
        for (const double theta_i : thetas)
            expect_as_walked(sheet, theta_i);
        expect_the_same_from_both_sides(sheet);
        expect_all_light(sheet);
    }
}

TEST(ThroughLobe, SmoothSheetsHaveNone) {
    const StackElements smooth = stack_at({{Layer{}}, LowerFace{}}, 550.0);
    EXPECT_EQ(through_lobe(std::span(&smooth, 1)), nullptr);
}
