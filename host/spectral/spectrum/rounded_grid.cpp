#include "host/spectral/spectrum/rounded_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace reradiant {

namespace {

constexpr double equal_in_steps = 1e-6;      // as grid_from_centres has it
constexpr double rounding_of_doubles = 1e-9; // of wavelengths, in nm

/// Returns the grid from the first to the last of at least two centres.
WavelengthGrid grid_between_ends(const std::vector<RoundedWavelength>& centres) {
    const int count = static_cast<int>(centres.size());
    return {centres.front().nm, (centres.back().nm - centres.front().nm) / (count - 1), count};
}

bool fits(const WavelengthGrid& grid, const std::vector<RoundedWavelength>& centres,
          double roundings, double tolerance_nm) {
    for (int band = 0; band < grid.count; ++band) {
        const RoundedWavelength& centre = centres[static_cast<std::size_t>(band)];
        if (!(std::abs(centre.nm - grid.centre_nm(band)) <=
              roundings * centre.rounding_nm + tolerance_nm))
            return false;
    }
    return true;
}

/// True when rounding the grid gives these centres. What lies halfway between two digits goes up,
/// or to the even one, by the habit of who rounded.
bool rounds_to(const WavelengthGrid& grid, const std::vector<RoundedWavelength>& centres) {
    if (!fits(grid, centres, 1.0, rounding_of_doubles))
        return false;
    bool halves_go_up = true, halves_go_even = true;
    for (int band = 0; band < grid.count; ++band) {
        const auto [nm, rounding_nm] = centres[static_cast<std::size_t>(band)];
        const double change = nm - grid.centre_nm(band);
        if (std::abs(change) < rounding_nm - rounding_of_doubles)
            continue;
        halves_go_up &= change > 0.0;
        halves_go_even &= std::fmod(std::round(nm / (2.0 * rounding_nm)), 2.0) == 0.0;
    }
    return halves_go_up || halves_go_even;
}

bool are_rounded(const WavelengthGrid& ends, const std::vector<RoundedWavelength>& centres) {
    constexpr double largest_rounding_in_steps = 0.2;
    double rounding_nm = 0.0;
    for (const RoundedWavelength& centre : centres)
        rounding_nm = std::max(rounding_nm, centre.rounding_nm);
    // Both ends are rounded too: what lies between may be off twice.
    return rounding_nm <= largest_rounding_in_steps * ends.step_nm &&
           fits(ends, centres, 2.0, rounding_of_doubles);
}

WavelengthGrid simplest_grid(const WavelengthGrid& ends,
                             const std::vector<RoundedWavelength>& centres) {
    constexpr int most_parts = 64;
    for (int parts = 1; parts <= most_parts; ++parts) {
        const WavelengthGrid simple{std::round(ends.from_nm * parts) / parts,
                                    std::round(ends.step_nm * parts) / parts, ends.count};
        if (rounds_to(simple, centres))
            return simple;
    }
    return ends;
}

} // namespace

WavelengthGrid grid_from_rounded_centres(const std::vector<RoundedWavelength>& centres,
                                         double step_of_single_nm) {
    if (centres.size() > 2) {
        const WavelengthGrid ends = grid_between_ends(centres);
        if (!fits(ends, centres, 0.0, equal_in_steps * ends.step_nm) && are_rounded(ends, centres))
            return simplest_grid(ends, centres);
    }
    std::vector<double> centres_nm;
    for (const RoundedWavelength& centre : centres)
        centres_nm.push_back(centre.nm);
    return grid_from_centres(centres_nm, step_of_single_nm);
}

} // namespace reradiant
