#include "host/spectral/spectrum/rounded_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

WavelengthGrid grid(const std::vector<double>& nm, double rounding_nm) {
    std::vector<RoundedWavelength> centres;
    for (const double value : nm)
        centres.push_back({value, rounding_nm});
    return grid_from_rounded_centres(centres);
}

/// Rounds as printf does, halves to the even digit.
std::vector<double> rounded(const WavelengthGrid& exact, double digits_per_nm) {
    std::vector<double> nm;
    for (int band = 0; band < exact.count; ++band)
        nm.push_back(std::nearbyint(exact.centre_nm(band) * digits_per_nm) / digits_per_nm);
    return nm;
}

} // namespace

TEST(RoundedGrid, CentresBecomeTheGridTheyCameFrom) {
    EXPECT_EQ(grid({380, 383.33, 386.67, 390}, 0.005), (WavelengthGrid{380, 10.0 / 3.0, 4}));
    // Cut out of the middle, the ends are rounded too.
    EXPECT_EQ(grid({383.33, 386.67, 390, 393.33}, 0.005),
              (WavelengthGrid{1150.0 / 3.0, 10.0 / 3.0, 4}));
    EXPECT_EQ(grid({380, 383, 387, 390}, 0.5), (WavelengthGrid{380, 10.0 / 3.0, 4}));
    EXPECT_EQ(grid({380, 383, 385, 388, 390, 393}, 0.5), (WavelengthGrid{380, 2.5, 6}));
    EXPECT_EQ(grid({400, 410, 420}, 0.5), (WavelengthGrid{400, 10, 3}));
    EXPECT_EQ(grid({400.1, 402.6, 405.1}, 0.05), (WavelengthGrid{400.1, 2.5, 3}));
    const WavelengthGrid pbrt{374.6875, 29.375, 16}, thirds{1150.0 / 3.0, 10.0 / 3.0, 16};
    EXPECT_EQ(grid(rounded(pbrt, 1e3), 5e-4), pbrt);
    EXPECT_EQ(grid(rounded(thirds, 1e2), 5e-3), thirds);
}

TEST(RoundedGrid, MissingBandsAreNotTakenForRounding) {
    EXPECT_THROW(grid({400, 401, 403}, 0.5), std::invalid_argument);
    EXPECT_THROW(grid({400, 410, 430}, 0.5), std::invalid_argument);
    EXPECT_THROW(grid({400, 410, 425}, 0.5), std::invalid_argument);
    EXPECT_THROW(grid({400, 410.1, 420}, 0.01), std::invalid_argument);
    EXPECT_THROW(grid({400, 410, 420.2, 430}, 0.05), std::invalid_argument);
    EXPECT_THROW(grid({400, 400}, 0.5), std::invalid_argument);
    EXPECT_THROW(grid({}, 0.5), std::invalid_argument);
}

} // namespace reradiant
