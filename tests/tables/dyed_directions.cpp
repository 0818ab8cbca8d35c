// Dyed stacks and sheets in directions by adding, against the random walk, as a Markdown table:
// light that dyes and the substrate shift to other bands, and light that keeps its band.
#include "tests/layers/dyed_directions.h"
#include "tests/support/statistics.h"

#include <fmt/core.h>

using namespace reradiant;
using namespace reradiant::test;

namespace {

int failures = 0;

std::string place_of(const DyedPair& pair) {
    return pair.walk > 0.0 ? fmt::format("{:.0f} % at {:.0f} to {:.0f}", 100.0 * pair.relative(),
                                         pair.theta_i_deg, pair.theta_o_deg)
                           : "-";
}

void print_row(const DyedCase& one, double bound) {
    constexpr std::uint64_t walks = 1U << 17U;
    const DyedDifference shifted = difference_of(compare_in_directions(one, true, walks, 1), bound),
                         kept = difference_of(compare_in_directions(one, false, walks, 4), bound);
    const bool good = shifted.beyond == 0 && (one.is_spread || kept.beyond == 0);
    failures += good ? 0 : 1;
    fmt::print("| {} | {:.1f} | {:.2f} % | {:.1f} % | {} | {:.2f} %{} |\n", one.name,
               std::fabs(shifted.worst_by_z.z()), 100.0 * shifted.mean, 100.0 * kept.mean,
               place_of(kept.worst_beyond), 100.0 * kept.mean_error,
               good ? "" : " **out of bounds**");
    std::fflush(stdout);
}

} // namespace

int main() {
    const double bound = sidak_bound(3.0 * 27.0 + 3.0 * 54.0);
    fmt::print("Directions of light at 0, 45 and 75 degrees; a bound of {:.2f} standard errors.\n\n"
               "| stack | shifted: largest z | mean difference | kept: mean difference | worst | "
               "mean s.e. of the walk |\n| --- | --- | --- | --- | --- | --- |\n",
               bound);
    for (const DyedCase& one : dyed_cases())
        print_row(one, bound);
    return failures > 0 ? 3 : 0;
}
