#include "host/spectral/rounded_grid.h"

#include <cmath>
#include <cstddef>
#include <optional>

namespace reradiant {

namespace {

constexpr double equal_in_steps = 1e-6;      // as grid_from_centres has it
constexpr double rounding_of_doubles = 1e-9; // of wavelengths, in nm

bool fits(const WavelengthGrid& grid, const std::vector<double>& centres_nm, double tolerance_nm) {
    for (int band = 0; band < grid.count; ++band)
        if (!(std::abs(centres_nm[static_cast<std::size_t>(band)] - grid.centre_nm(band)) <=
              tolerance_nm))
            return false;
    return true;
}

/// From the first to the last of at least two centres.
WavelengthGrid grid_between_ends(const std::vector<double>& centres_nm) {
    const int count = static_cast<int>(centres_nm.size());
    return {centres_nm.front(), (centres_nm.back() - centres_nm.front()) / (count - 1), count};
}

/// True when rounding the grid gives these centres. What lies halfway between two digits goes up,
/// or to the even one, by the habit of who rounded.
bool rounds_to(const WavelengthGrid& grid, const std::vector<double>& centres_nm,
               double rounding_nm) {
    bool halves_go_up = true, halves_go_even = true;
    for (int band = 0; band < grid.count; ++band) {
        const double centre = centres_nm[static_cast<std::size_t>(band)];
        const double change = centre - grid.centre_nm(band);
        if (!(std::abs(change) <= rounding_nm + rounding_of_doubles))
            return false;
        if (std::abs(change) < rounding_nm - rounding_of_doubles)
            continue;
        halves_go_up &= change > 0.0;
        halves_go_even &= std::fmod(std::round(centre / (2.0 * rounding_nm)), 2.0) == 0.0;
    }
    return halves_go_up || halves_go_even;
}

/// Of the grids near the one between the ends.
std::optional<WavelengthGrid> simplest_grid(const WavelengthGrid& ends,
                                            const std::vector<double>& centres_nm,
                                            double rounding_nm) {
    constexpr int most_parts = 12;
    for (int parts = 1; parts <= most_parts; ++parts) {
        const WavelengthGrid simple{std::round(ends.from_nm * parts) / parts,
                                    std::round(ends.step_nm * parts) / parts, ends.count};
        if (rounds_to(simple, centres_nm, rounding_nm))
            return simple;
    }
    if (rounds_to(ends, centres_nm, rounding_nm))
        return ends;
    return std::nullopt;
}

} // namespace

WavelengthGrid grid_from_rounded_centres(const std::vector<double>& centres_nm, double rounding_nm,
                                         double step_of_single_nm) {
    constexpr double largest_rounding_in_steps = 0.2;
    if (centres_nm.size() > 2) {
        const WavelengthGrid ends = grid_between_ends(centres_nm);
        if (!fits(ends, centres_nm, equal_in_steps * ends.step_nm) &&
            rounding_nm <= largest_rounding_in_steps * ends.step_nm)
            if (const auto grid = simplest_grid(ends, centres_nm, rounding_nm))
                return *grid;
    }
    return grid_from_centres(centres_nm, step_of_single_nm);
}

} // namespace reradiant
