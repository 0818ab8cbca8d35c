// Dyed stacks and sheets in directions: adding against the walk. What dyes and the substrate shift
// to another band is exact; light that keeps its band is so in clear slabs between smooth faces,
// and has approximate lobes where faces or clouds spread it (tools/tables dyed_directions says by
// how much).
#include "tests/layers/dyed_directions.h"
#include "tests/support/private_cache.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

using namespace reradiant;
using namespace reradiant::test;

namespace {

const PrivateCache cache("dyed_directions");

void expect_within(const std::vector<DyedPair>& pairs, double bound, const std::string& what) {
    ASSERT_FALSE(pairs.empty()) << what;
    const DyedPair& worst = difference_of(pairs, bound).worst_by_z;
    EXPECT_LE(std::fabs(worst.z()), bound)
        << what << ": adding " << worst.adding << ", walk " << worst.walk << " +- " << worst.error
        << " at " << worst.theta_i_deg << " to " << worst.theta_o_deg << ", band "
        << worst.excitation << " to " << worst.emission;
}

} // namespace

TEST(DyedDirections, ShiftedBandsAreThoseOfTheWalk) {
    const double bound = sidak_bound(3.0 * 27.0 + 3.0 * 54.0);
    std::uint64_t seed = 1;
    for (const DyedCase& one : dyed_cases())
        expect_within(compare_in_directions(one, true, samples(4000), seed++), bound, one.name);
}

TEST(DyedDirections, BandsThatLightKeepsAreThoseOfTheWalkInClearSlabs) {
    const double bound = sidak_bound(27.0 + 54.0);
    for (const DyedCase& one : dyed_cases())
        if (!one.is_spread)
            expect_within(compare_in_directions(one, false, samples(8000), 7), bound, one.name);
}

TEST(DyedDirections, BandsThatLightKeepsAreNearThoseOfTheWalkInClouds) {
    for (const DyedCase& one : dyed_cases())
        if (one.stack.scatters()) {
            const std::vector<DyedPair> pairs =
                compare_in_directions(one, false, samples(4000), 11);
            const DyedDifference found = difference_of(pairs, sidak_bound(54.0));
            EXPECT_LT(found.mean, 0.1) << one.name;
            EXPECT_LT(found.worst_beyond.walk > 0.0 ? found.worst_beyond.relative() : 0.0, 0.4)
                << one.name;
        }
}
