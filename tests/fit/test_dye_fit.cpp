#include "host/fit/dye/dye_fit.h"

#include "host/fit/dye/dye_model.h"
#include "host/fit/dye/dye_problem.h"
#include "reradiant/error.h"
#include "tests/tables/dye_recovery_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace reradiant {

namespace {

std::vector<BispectralData> data_of(const DyeCase& what,
                                    const std::function<void(SynthRecipe&)>& change = {}) {
    std::vector<BispectralData> data;
    for (const double depth : what.depths) {
        SynthRecipe recipe = dye_recipe(what, depth);
        if (change)
            change(recipe);
        data.push_back(synthesise(recipe, static_cast<unsigned>(data.size()) + 1).data);
    }
    return data;
}

void expect_refused(const DyeFitSettings& settings, const std::vector<BispectralData>& data,
                    const std::string& words) {
    try {
        fit_dyes(data, settings);
        ADD_FAILURE() << "not refused: " << words;
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2);
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
}

} // namespace

TEST(DyeFit, FindsADyeOverWhite) {
    const DyeCase what{1, {1.0}, 0.01, 0.0, 0.9};
    const DyeFitResult result = fit_dyes(data_of(what), dye_settings(what));
    ASSERT_EQ(result.failure, "");
    const DyeError error = dye_error(what, result, 0);
    // the standard error of the yield is 0.45 %, that of the depth 1.1 %
    EXPECT_LT(std::fabs(error.yield), 0.02);
    EXPECT_LT(std::fabs(error.peak_depth), 0.04);
    EXPECT_LT(error.absorption_of_peak, 0.01);
    EXPECT_LT(error.emission_of_peak, 0.015);
    EXPECT_GE(error.spectra_covered, 0.85);
    EXPECT_TRUE(result.shortfall.empty()) << result.shortfall;
    // what the dye is said to send out is possible
    const ColumnBalance balance = column_balance(result.matrix);
    for (const double photons : balance.photons)
        EXPECT_LE(photons, 1.0);
}

TEST(DyeFit, ASeriesOfThicknessesTellsYieldAndConcentrationOverBlack) {
    const DyeCase what{1, {0.2, 2.0}, 0.01, 0.0, 0.0};
    const DyeFitResult result = fit_dyes(data_of(what), dye_settings(what));
    ASSERT_EQ(result.failure, "");
    const DyeError error = dye_error(what, result, 0);
    EXPECT_LT(std::fabs(error.yield), 0.02);
    EXPECT_LT(std::fabs(error.peak_depth), 0.05);
}

TEST(DyeFit, WhatOneThinLayerOverBlackDoesNotTellItDoesNotClaim) {
    // at a depth of 0.1 only the product of yield and depth is seen
    const DyeCase what{1, {0.1}, 0.01, 0.0, 0.0};
    const DyeFitResult result = fit_dyes(data_of(what), dye_settings(what));
    const BandedNumber& yield = result.dyes[0].quantum_yield;
    EXPECT_GT(yield.high - yield.low, 0.3);
    EXPECT_LE(yield.low, 0.8);
    EXPECT_GE(yield.high, 0.8);
}

TEST(DyeFit, CountsOfAnUnknownScaleGiveTheSpectraOfSaturatedReadingsToo) {
    DyeCase what{1, {0.2, 2.0}, 0.01, 0.0, 0.9};
    const Spectrum lamp = Spectrum::table({300.0, 780.0}, {0.5, 1.5});
    const auto data = data_of(what, [&](SynthRecipe& recipe) {
        recipe.instrument.lamp = lamp;
        recipe.instrument.scale = 1000.0;
        recipe.instrument.ceiling = 600.0;
    });
    DyeFitSettings settings = dye_settings(what);
    settings.is_arbitrary_unit = true;
    settings.lamp = lamp;
    settings.ceiling = 600.0;
    const DyeFitResult result = fit_dyes(data, settings);
    ASSERT_EQ(result.failure, "");
    EXPECT_LT(dye_error(what, result, 0).absorption_of_peak, 0.02);
    ASSERT_TRUE(result.scale);
    EXPECT_LE(result.scale->low, 1000.0);
    EXPECT_GE(result.scale->high, 1000.0);
}

TEST(DyeFit, DerivativesOfResidualsAreThoseOfDifferences) {
    DyeCase what{1, {0.3, 1.0}, 0.01, 0.0, 0.9};
    DyeFitSettings settings = dye_settings(what);
    settings.is_arbitrary_unit = true;
    const auto data = data_of(what);
    const PreparedDyes prepared = prepare_dyes(data, settings, 3.0);
    const DyeModel model(prepared.problem, per_band_basis(prepared.problem.bands),
                         spline_basis(data.front().emission, 30.0), 1);
    Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(model.size(), 0.4, 0.6);
    Eigen::VectorXd residual, above, below;
    Eigen::MatrixXd jacobian;
    model.evaluate(at, residual, &jacobian);
    for (Eigen::Index k = 0; k < at.size(); k += 5) {
        constexpr double step = 1e-5;
        Eigen::VectorXd moved = at;
        moved(k) += step;
        model.evaluate(moved, above, nullptr);
        moved(k) -= 2.0 * step;
        model.evaluate(moved, below, nullptr);
        const Eigen::VectorXd difference = (above - below) / (2.0 * step);
        EXPECT_LT((jacobian.col(k) - difference).cwiseAbs().maxCoeff(),
                  1e-6 * (1.0 + jacobian.col(k).cwiseAbs().maxCoeff()))
            << k;
    }
}

TEST(DyeFit, RefusesWhatDoesNotBelongTogether) {
    const DyeCase what{1, {1.0}, 0.01, 0.0, 0.9};
    const auto data = data_of(what);
    const DyeFitSettings good = dye_settings(what);
    DyeFitSettings bad = good;
    bad.layer = 3;
    expect_refused(bad, data, "--dye 4: the stack has 1 layer");
    bad = good;
    bad.thickness = {-1.0};
    expect_refused(bad, data, "--thickness -1 is out of range");
    bad.thickness = {1.0, 2.0};
    expect_refused(bad, data, "2 numbers for 1 data sets");
    bad = good;
    bad.lamp = Spectrum::constant(1.0);
    expect_refused(bad, data, "--lamp contradicts");
    bad = good;
    bad.is_arbitrary_unit = bad.fits_substrate = true;
    expect_refused(bad, data, "neither the data's scale");
    bad = good;
    bad.mask = mask_rules_from_text("box:300-800x300-800");
    expect_refused(bad, data, "leaves no entry");
    bad = good;
    bad.ceiling = 1e-9;
    bad.mask = mask_rules_from_text("none");
    bad.spill_nm = 1000.0;
    bad.material.stack.layers[0].scattering_coefficient = Spectrum::constant(1.0);
    expect_refused(bad, data, "no entry is left to fit");
    bad = good;
    bad.material.stack.lower_face = LowerFace{};
    expect_refused(bad, data, "total reflection keeps light");
}

} // namespace reradiant
