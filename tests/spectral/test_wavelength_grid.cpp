#include "reradiant/wavelength_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace reradiant;

TEST(Grid, RangeHoldsBothEnds) {
    const WavelengthGrid grid = grid_from_range(300, 780, 10);
    EXPECT_EQ(grid.count, 49);
    EXPECT_EQ(grid.to_nm(), 780.0);
    EXPECT_EQ(grid.lower_edge_nm(0), 295.0);
    EXPECT_EQ(grid.upper_edge_nm(48), 785.0);
}

TEST(Grid, RangeOfThirdsIsWholeDespiteRounding) {
    EXPECT_EQ(grid_from_range(400, 500, 100.0 / 3.0).count, 4);
    EXPECT_EQ(grid_from_range(380, 380.3, 0.1).count, 4);
}

TEST(Grid, RangeRefusesWhatIsNoGrid) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(grid_from_range(300, 785, 10), std::invalid_argument);
    EXPECT_THROW(grid_from_range(300, 780, 0), std::invalid_argument);
    EXPECT_THROW(grid_from_range(300, 780, -10), std::invalid_argument);
    EXPECT_THROW(grid_from_range(0, 780, 10), std::invalid_argument);
    EXPECT_THROW(grid_from_range(780, 300, 10), std::invalid_argument);
    EXPECT_THROW(grid_from_range(nan, 780, 10), std::invalid_argument);
    EXPECT_THROW(grid_from_range(300, nan, 10), std::invalid_argument);
    EXPECT_THROW(grid_from_range(300, 780, 1e-9), std::invalid_argument);
    EXPECT_THROW(grid_from_range(300, 1e300, 1), std::invalid_argument);
}

TEST(Grid, CellsAreHalfOpenAndOutsideIsMinusOne) {
    const WavelengthGrid grid = grid_from_range(380, 780, 10);
    EXPECT_EQ(grid.band_of(375.0), 0);
    EXPECT_EQ(grid.band_of(384.999), 0);
    EXPECT_EQ(grid.band_of(385.0), 1);
    EXPECT_EQ(grid.band_of(784.999), 40);
    EXPECT_EQ(grid.band_of(785.0), -1);
    EXPECT_EQ(grid.band_of(374.999), -1);
    EXPECT_EQ(grid.band_of(std::numeric_limits<double>::quiet_NaN()), -1);
    EXPECT_EQ(grid.band_of(std::numeric_limits<double>::infinity()), -1);
    EXPECT_EQ(grid.band_of(-1e300), -1);
}

TEST(Grid, EveryCentreLiesInItsOwnCell) {
    for (const double step : {0.1, 1.0 / 3.0, 1.0, 7.0, 10.0}) {
        const WavelengthGrid grid{300.0, step, 1000};
        for (int band = 0; band < grid.count; ++band)
            EXPECT_EQ(grid.band_of(grid.centre_nm(band)), band) << step;
    }
}

TEST(Grid, CentresMustAscendInEqualSteps) {
    EXPECT_EQ(grid_from_centres({380, 390, 400}), (WavelengthGrid{380, 10, 3}));
    EXPECT_EQ(grid_from_centres({550}, 5.0), (WavelengthGrid{550, 5, 1}));
    EXPECT_THROW(grid_from_centres({}), std::invalid_argument);
    EXPECT_THROW(grid_from_centres({380, 380, 390}), std::invalid_argument);
    EXPECT_THROW(grid_from_centres({380, 390, 401}), std::invalid_argument);
    EXPECT_THROW(grid_from_centres({390, 380}), std::invalid_argument);
    EXPECT_THROW(grid_from_centres({-10, 0, 10}), std::invalid_argument);
    EXPECT_THROW(grid_from_centres({550}, 0.0), std::invalid_argument);
}
