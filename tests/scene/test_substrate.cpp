#include "host/scene/model/substrate.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>

using namespace reradiant;

namespace {

/// Excitation 400-420, emission 400-420 by 10, one fluorescent entry 400 -> 420 nm.
Substrate small_matrix() {
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = grid_from_range(400, 420, 10);
    matrix.values = Eigen::MatrixXd::Zero(3, 3);
    matrix.values.diagonal() << 0.1, 0.2, 0.3;
    matrix.values(2, 0) = 0.25;
    Substrate substrate;
    substrate.reflectance = matrix.reflectance();
    substrate.matrix = std::make_shared<const ReradiationMatrix>(matrix);
    return substrate;
}

/// The matrix of a substrate, edited.
template <typename Edit>
Substrate edited(Substrate substrate, const Edit& edit) {
    ReradiationMatrix matrix = *substrate.matrix;
    edit(matrix);
    substrate.matrix = std::make_shared<const ReradiationMatrix>(matrix);
    return substrate;
}

Substrate with_emission(const Substrate& substrate, const WavelengthGrid& emission) {
    return edited(substrate, [&](ReradiationMatrix& matrix) { matrix.emission = emission; });
}

Substrate fluorophore(double quantum_yield) {
    Substrate substrate;
    substrate.fluorophores = {{Spectrum::table({300, 390, 400, 410, 500}, {0, 0, 0.8, 0, 0}),
                               Spectrum::table({500, 590, 600, 610, 700}, {0, 0, 1, 0, 0}),
                               quantum_yield}};
    return substrate;
}

} // namespace

TEST(Substrate, IsFluorescentOnlyWhenWavelengthsShift) {
    EXPECT_FALSE(Substrate{}.is_fluorescent());
    EXPECT_TRUE(small_matrix().is_fluorescent());
    const Substrate grey =
        edited(small_matrix(), [](ReradiationMatrix& matrix) { matrix.values(2, 0) = 0.0; });
    EXPECT_FALSE(grey.is_fluorescent());
    EXPECT_TRUE(fluorophore(0.5).is_fluorescent());
    EXPECT_FALSE(fluorophore(0.0).is_fluorescent());
}

TEST(Substrate, RangesAreThoseOfTheCellsThatShift) {
    const Substrate matrix = small_matrix();
    EXPECT_EQ(matrix.excitation_range_nm(), (std::array{395.0, 405.0}));
    EXPECT_EQ(matrix.emission_range_nm(), (std::array{415.0, 425.0}));
    const auto excitation = fluorophore(1.0).excitation_range_nm();
    const auto emission = fluorophore(1.0).emission_range_nm();
    // Supports are found to 1 nm.
    EXPECT_NEAR(excitation[0], 390.0, 1.0);
    EXPECT_NEAR(excitation[1], 410.0, 1.0);
    EXPECT_NEAR(emission[0], 590.0, 1.0);
    EXPECT_NEAR(emission[1], 610.0, 1.0);
    EXPECT_EQ(Substrate{}.excitation_range_nm(), (std::array{0.0, 0.0}));
}

TEST(Substrate, ExcitationAboveEveryEmissionDoesNotCount) {
    Substrate reversed;
    reversed.fluorophores = {{Spectrum::table({600, 650, 700}, {0, 0.8, 0}),
                              Spectrum::table({400, 450, 500}, {0, 1, 0}), 1.0}};
    EXPECT_FALSE(reversed.is_fluorescent());
}

TEST(Substrate, OwnGridIsTheUnionWhenTheStepsAgree) {
    Substrate substrate = small_matrix();
    EXPECT_EQ(*substrate.own_grid(), grid_from_range(400, 420, 10));
    substrate = with_emission(substrate, grid_from_range(420, 440, 10));
    EXPECT_EQ(*substrate.own_grid(), grid_from_range(400, 440, 10));
    substrate = with_emission(substrate, grid_from_range(425, 445, 10));
    EXPECT_FALSE(substrate.own_grid().has_value());
    substrate = with_emission(substrate, grid_from_range(420, 430, 5));
    EXPECT_FALSE(substrate.own_grid().has_value());
    EXPECT_FALSE(fluorophore(1.0).own_grid().has_value());
}

TEST(Substrate, FluorescenceOnItsOwnCellsIsTheMatrixWithoutReflectance) {
    const Eigen::MatrixXd cells = fluorescence_of(small_matrix(), grid_from_range(400, 420, 10));
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, 3);
    expected(2, 0) = 0.25;
    // Both grids have the same cells: overlaps are whole cells, exact to rounding.
    EXPECT_LE((cells - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Substrate, FluorophoresConservePhotonsOnAnyCells) {
    for (const double step : {5.0, 10.0, 20.0}) {
        const WavelengthGrid grid = grid_from_range(300, 780, step);
        const Eigen::MatrixXd cells = fluorescence_of(fluorophore(0.9), grid);
        double absorbed = 0.0, emitted = 0.0;
        for (int i = 0; i < grid.count; ++i) {
            absorbed += 0.9 * step *
                        Spectrum(fluorophore(0.9).fluorophores[0].excitation)
                            .average(grid.lower_edge_nm(i), grid.upper_edge_nm(i));
            for (int o = 0; o < grid.count; ++o)
                emitted += cells(o, i) * step * grid.centre_nm(o) / grid.centre_nm(i);
        }
        // Cell centres stand for the cells: second order in step over wavelength, (20/400)^2.
        EXPECT_NEAR(emitted / absorbed, 1.0, 2e-3) << step;
    }
    EXPECT_EQ(fluorescence_of(Substrate{}, grid_from_range(400, 420, 10)).norm(), 0.0);
}

TEST(Models, NamesGoBothWays) {
    for (const char* name : {"auto", "adding", "weidlich-wilkie", "walk"})
        EXPECT_STREQ(model_name(model_from_name(name)), name);
    EXPECT_THROW(model_from_name("magic"), std::invalid_argument);
}
