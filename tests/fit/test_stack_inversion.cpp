#include "host/fit/stack/stack_inversion.h"
#include "host/measure/measure_substrate.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"
#include "reradiant/reradiation.h"
#include "tests/film/film_fixtures.h"
#include "tests/fit/fit_cases.h"
#include "tests/support/full_run.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <numbers>

using namespace reradiant;

namespace {

WavelengthGrid square_grid() {
    return {300.0, 20.0, 25};
}

/// Absorbs 0.8 and sends 0.72 of the photons out again at most: with more reflectance than 0.28 it
/// would break the photon balance, which a fit keeps.
ReradiationMatrix substrate() {
    return true_matrix({two_fluorophores()[0]}, square_grid(), square_grid(), 0.2);
}

/// A varnish that yellows: absorbs in the blue.
LayerStack varnish(double thickness = 0.5) {
    Layer layer;
    layer.thickness = thickness;
    layer.absorption = Spectrum::table({300.0, 400.0, 500.0, 780.0}, {1.2, 0.8, 0.1, 0.02});
    return {{layer}};
}

/// Returns the data of an instrument that sees the substrate under a stack, with the same noise
/// everywhere.
BispectralData seen_through(const LayerStack& stack, double noise,
                            const std::vector<double>& theta_o, unsigned seed = 1) {
    MeasureRequest request;
    request.theta_i_deg = {0.0, 45.0};
    request.theta_o_deg = theta_o;
    const ReradiationMatrix truth = substrate();
    const Measurement measured = measure_stack(stack, truth.values, square_grid(), request);
    BispectralData data;
    data.file = "through.csv";
    data.emission = data.excitation = square_grid();
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (const MeasureRow& row : measured.rows) {
        if (row.part != MeasuredPart::Diffuse)
            continue;
        const BispectralGeometry geometry{row.theta_i_deg, row.theta_o_deg, row.phi_deg};
        if (data.blocks.empty() || data.blocks.back().geometry != geometry)
            data.blocks.push_back(
                {geometry, Eigen::MatrixXd::Zero(25, 25),
                 Eigen::MatrixXd::Constant(25, 25, noise > 0.0 ? noise : not_measured)});
        data.blocks.back().value(square_grid().band_of(row.lambda_o_nm),
                                 square_grid().band_of(row.lambda_i_nm)) =
            std::numbers::pi * row.value;
    }
    for (BispectralBlock& block : data.blocks)
        for (double& value : block.value.reshaped())
            value += noise * normal(random);
    return data;
}

} // namespace

TEST(StackInversion, UndoesModelB) {
    const SubstrateData bare =
        invert_stack(seen_through(varnish(), 0.0, {0.0, 60.0}), varnish(), {});
    // Both ways use the same formulas in double precision; the varnish passes 9 % at 300 nm.
    EXPECT_LE((bare.data.blocks[0].value - substrate().values).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_FALSE(bare.data.blocks[0].geometry);
}

TEST(StackInversion, FindsTheThicknessFromSeveralAngles) {
    UnknownLayers unknown;
    unknown.thickness = true;
    const double noise = 1e-3;
    const SubstrateData bare =
        invert_stack(seen_through(varnish(0.5), noise, {0.0, 40.0, 75.0}), varnish(0.3), unknown);
    ASSERT_EQ(bare.estimate.names.size(), 1u);
    EXPECT_EQ(bare.estimate.rank, 1);
    // Sidak at 1e-6 for one number: 4.9 standard errors.
    EXPECT_LE(std::abs(bare.estimate.value(0) - 0.5), 4.9 * bare.estimate.sigma(0));
    EXPECT_LE(bare.estimate.sigma(0), 0.05);
    EXPECT_NEAR(bare.estimate.reduced_chi_squared, 1.0, 0.2);
}

TEST(StackInversion, SaysThatThicknessAndAbsorptionAreOne) {
    UnknownLayers unknown;
    unknown.thickness = unknown.absorption = true;
    const SubstrateData bare =
        invert_stack(seen_through(varnish(0.5), 1e-3, {0.0, 40.0, 75.0}), varnish(0.4), unknown);
    EXPECT_EQ(bare.estimate.rank, 1);
    ASSERT_EQ(bare.estimate.ambiguities.size(), 1u);
    EXPECT_NE(bare.estimate.ambiguities[0].find("thickness of layer 1"), std::string::npos);
    EXPECT_NE(bare.estimate.ambiguities[0].find("absorption scale of layer 1"), std::string::npos);
    EXPECT_TRUE(std::isinf(bare.estimate.sigma(0)));
}

TEST(StackInversion, FindsTheProductOfThicknessAndAbsorption) {
    // Their product is what the light knows: to 5 % from one measurement like this (a standard
    // error that follows from the noise, the path lengths and the signal), so of eight the mean.
    UnknownLayers unknown;
    unknown.thickness = unknown.absorption = true;
    UnknownLayers thickness;
    thickness.thickness = true;
    double mean = 0.0;
    constexpr unsigned runs = 8;
    for (unsigned seed = 1; seed <= runs; ++seed) {
        const BispectralData data = seen_through(varnish(0.5), 1e-3, {0.0, 40.0, 75.0}, seed);
        const StackEstimate both = invert_stack(data, varnish(0.4), unknown).estimate;
        const StackEstimate one = invert_stack(data, varnish(0.4), thickness).estimate;
        const double product = both.value(0) * both.value(1);
        EXPECT_NEAR(product, one.value(0), 1e-4) << seed;
        EXPECT_LE(std::abs(product - 0.5), 4.9 * one.sigma(0)) << seed;
        mean += product / runs;
    }
    EXPECT_NEAR(mean, 0.5, 0.05);
}

TEST(StackInversion, FitsThroughTheLayer) {
    FitSettings settings;
    settings.stack = varnish();
    settings.rank = 1;
    const FitResult fit = fit_reradiation(seen_through(varnish(), 1e-4, {0.0, 60.0}), settings);
    EXPECT_EQ(fit.failure, "");
    const double covered = coverage(fit, substrate());
    EXPECT_LE(stokes_rmse(fit.matrix, substrate()), 3e-3 * stokes_peak(substrate()));
    EXPECT_GE(covered, 0.88); // one run of 300 correlated entries
}

TEST(StackInversion, BandsThroughTheLayerCoverTheTruth) {
    FitSettings settings;
    settings.stack = varnish();
    settings.rank = 1;
    const unsigned runs = test::is_full_run() ? 20 : 4;
    for (const double noise : {1e-4, 2e-3}) {
        double mean = 0.0;
        for (unsigned seed = 1; seed <= runs; ++seed)
            mean += coverage(fit_reradiation(seen_through(varnish(), noise, {0.0, 60.0}, seed),
                                             settings),
                             substrate()) /
                    runs;
        EXPECT_GE(mean, 0.90) << noise; // the bar of the project
        EXPECT_LE(mean, 0.99) << noise;
    }
}

TEST(StackInversion, ImpossibleQuestionsAreRefused) {
    UnknownLayers unknown;
    unknown.thickness = true;
    BispectralData one = seen_through(varnish(), 1e-3, {0.0});
    one.blocks.resize(1);
    EXPECT_THROW(invert_stack(one, varnish(), unknown), Error);
    EXPECT_THROW(invert_stack(one, LayerStack{}, unknown), Error);
    BispectralData bare = noisy_data(substrate(), 1e-3, true, 1);
    EXPECT_THROW(invert_stack(bare, varnish(), {}), Error);
    bare.geometry = "45/0";
    EXPECT_NO_THROW(invert_stack(bare, varnish(), {}));
    EXPECT_THROW(unknown_layers_from_names({"colour"}), Error);
}
