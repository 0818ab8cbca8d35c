#include "host/study/study/cell_measurement.h"

#include "reradiant/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace reradiant {
namespace {

Material bare(double reflectance) {
    Material material;
    material.substrate.reflectance = Spectrum::constant(reflectance);
    return material;
}

NamedIlluminant lamp(const std::string& name) {
    return {name, illuminant_with_luminance(name, 1.0)};
}

// A perfect diffuser is white by definition, whatever the lamp. 1e-9: sums of some 40 bands.
TEST(CellMeasurement, PerfectDiffuserHasTheWhiteOfTheLamp) {
    const CellMeasurement cell = measure_cell(bare(1.0), {}, {lamp("D65"), lamp("A")});
    ASSERT_EQ(cell.colours.size(), 2u);
    for (const SeenColour& colour : cell.colours) {
        EXPECT_NEAR(colour.xyz[1], 100.0, 1e-9);
        EXPECT_NEAR(colour.lab[0], 100.0, 1e-9);
        EXPECT_NEAR(colour.lab[1], 0.0, 1e-6);
        EXPECT_NEAR(colour.lab[2], 0.0, 1e-6);
        for (const double beta : colour.beta_t)
            EXPECT_NEAR(beta, 1.0, 1e-9);
        EXPECT_TRUE(std::isnan(colour.quantum_yield)) << "nothing fluoresces";
    }
    for (const double value : cell.polar[0].total)
        EXPECT_NEAR(value, 1.0, 1e-9) << "a diffuser looks alike from everywhere";
}

// Light that the dye absorbs is re-radiated with its yield; the rest is reflected. The bound of 2 %
// is for bands of 10 nm, which keep what is emitted within the band of the excitation on the
// diagonal.
TEST(CellMeasurement, QuantumYieldOfABareDyeIsItsOwn) {
    Material material = bare(0.0);
    material.substrate.fluorophores = {
        {Spectrum::table({300, 344.9, 345, 455, 455.1, 780}, {0, 0, 0.6, 0.6, 0, 0}),
         Spectrum::gaussian(580, 15, 1.0), 0.7}};
    material.substrate.reflectance =
        Spectrum::table({300, 344.9, 345, 455, 455.1, 780}, {1, 1, 0.4, 0.4, 1, 1});
    const CellMeasurement cell = measure_cell(material, {}, {lamp("D65")});
    EXPECT_NEAR(cell.colours[0].quantum_yield, 0.7, 0.014);
    EXPECT_GT(*std::max_element(cell.colours[0].beta_t.begin(), cell.colours[0].beta_t.end()), 1.2)
        << "fluorescent light comes on top and is not clamped";
}

TEST(CellMeasurement, BandsWithoutLightHaveNoRadianceFactor) {
    const CellMeasurement cell =
        measure_cell(bare(0.5), {}, {{"line", Spectrum::line(410, 2, 10.0)}});
    const auto& beta = cell.colours[0].beta_t;
    const int lit = cell.bands.band_of(410);
    for (int band = 0; band < cell.bands.count; ++band)
        if (band == lit)
            EXPECT_NEAR(beta[static_cast<std::size_t>(band)], 0.5, 1e-9);
        else
            EXPECT_TRUE(std::isnan(beta[static_cast<std::size_t>(band)])) << band;
}

// A mercury lamp alone shows no white: L* was 2042 and beta_T 1.8e43 under such lamps.
TEST(CellMeasurement, WhatIsRelativeToADarkWhiteIsLeftOut) {
    const CellMeasurement cell =
        measure_cell(bare(0.5), {}, {{"lamp", Spectrum::gaussian(365, 5, 1.0)}, lamp("D65")});
    const auto is_left_out = [](double value) { return std::isnan(value); };
    for (const SeenColour& colour : cell.colours) {
        const bool dark = colour.illuminant == "lamp";
        EXPECT_EQ(std::all_of(colour.xyz.begin(), colour.xyz.end(), is_left_out), dark);
        EXPECT_EQ(std::all_of(colour.lab.begin(), colour.lab.end(), is_left_out), dark);
        EXPECT_EQ(std::isnan(colour.reflected), dark);
        for (const double factor : colour.beta_t)
            EXPECT_TRUE(std::isnan(factor) || std::abs(factor - 0.5) < 1e-9) << factor;
    }
    EXPECT_TRUE(std::all_of(cell.polar[0].total.begin(), cell.polar[0].total.end(), is_left_out));
    const auto says_so = [](const std::string& note) {
        return note.find("lamp: a white surface is all but dark") == 0;
    };
    EXPECT_EQ(std::count_if(cell.notes.begin(), cell.notes.end(), says_so), 1);
}

TEST(CellMeasurement, PolarCurveHasTheHighlightOnTheMirrorSide) {
    Material material = bare(0.2);
    Layer layer;
    layer.alpha = 0.1;
    material.stack.layers = {layer};
    const CellMeasurement cell = measure_cell(material, {}, {lamp("D65")});
    const PolarCurve& curve = cell.polar[0];
    const auto peak = std::max_element(curve.total.begin(), curve.total.end());
    EXPECT_NEAR(curve.angle_deg[static_cast<std::size_t>(peak - curve.total.begin())], 45.0, 5.0);
    EXPECT_GT(*peak, 10.0 * curve.diffuse[0]);
}

Material sheet_of(const Layer& layer) {
    Material sheet;
    sheet.stack.layers = {layer};
    sheet.stack.lower_face.emplace();
    sheet.substrate.type = SubstrateType::None;
    return sheet;
}

// A smooth lossless sheet of n = 1.5 reflects 1/13 and lets 12/13 through at normal incidence.
TEST(CellMeasurement, ClearSheetsReflectAndLetThrough) {
    StudyMeasuring measuring;
    measuring.theta_i_deg = {0.0};
    measuring.theta_o_deg = {0.0, 180.0};
    const CellMeasurement cell = measure_cell(sheet_of({}), measuring, {lamp("D65"), lamp("A")});
    EXPECT_TRUE(cell.of_sheet());
    ASSERT_EQ(cell.colours.size(), 4u) << "two directions, two lamps";
    for (const SeenColour& colour : cell.colours) {
        EXPECT_NEAR(colour.reflected, 100.0 / 13.0, 1e-9);
        EXPECT_NEAR(colour.transmitted, 1200.0 / 13.0, 1e-9);
        EXPECT_EQ(colour.guided, 0.0);
    }
    const CellMeasurement opaque = measure_cell(bare(0.5), {}, {lamp("D65")});
    EXPECT_NEAR(opaque.colours[0].reflected, 50.0, 1e-9);
    EXPECT_TRUE(std::isnan(opaque.colours[0].transmitted));
}

// What comes in at 400 nm leaves at 500 on both sides or is guided, sqrt(1 - 1/n^2) of it. The rest
// is the dye's yield: 1e-4 is what adding promises.
TEST(CellMeasurement, DyedSheetsSendLightToBothSidesAndGuideIt) {
    Layer layer;
    layer.dyes = {{Spectrum::table({399, 400, 401}, {0, 3, 0}), 1.0, Spectrum::line(500, 10, 10.0),
                   0.5, nullptr}};
    StudyMeasuring measuring;
    measuring.theta_i_deg = {0.0};
    measuring.theta_o_deg = {30.0, 150.0};
    Spectrum lines = Spectrum::line(400, 10, 10.0);
    lines += Spectrum::line(560, 10, 1.0); // shows a white, and excites nothing
    const CellMeasurement cell = measure_cell(sheet_of(layer), measuring, {{"lines", lines}});
    const int in = cell.bands.band_of(400), out = cell.bands.band_of(500);
    const double leaves = cell.matrix(out, in) + cell.transmitted(out, in);
    EXPECT_NEAR(cell.transmitted(out, in), cell.matrix(out, in), 1e-6)
        << "what nothing absorbs leaves alike on both sides";
    EXPECT_GT(cell.transmitted(out, in), 0.01);
    const double guided = cell.guided(out, in);
    EXPECT_NEAR(guided / (guided + leaves), std::sqrt(1.0 - 1.0 / 2.25), 1e-4);
    for (const SeenColour& colour : cell.colours)
        EXPECT_NEAR(colour.quantum_yield, 0.5 * leaves / (guided + leaves), 1e-4);
    EXPECT_NEAR(cell.colours[1].xyz[1] / cell.colours[0].xyz[1], 1.0, 1e-4)
        << "seen from the far side";
}

TEST(CellMeasurement, PolarCurvesOfSheetsGoRoundBothSides) {
    Layer layer;
    layer.alpha = 0.2;
    Material sheet = sheet_of(layer);
    const CellMeasurement cell = measure_cell(sheet, {}, {lamp("D65")});
    const PolarCurve& curve = cell.polar[0];
    EXPECT_EQ(curve.angle_deg.front(), -180.0);
    EXPECT_EQ(curve.angle_deg.back(), 180.0);
    const auto straight =
        std::max_element(curve.total.begin(), curve.total.end(), [](double a, double b) {
            return (std::isnan(a) ? 0.0 : a) < (std::isnan(b) ? 0.0 : b);
        });
    const auto at = static_cast<std::size_t>(straight - curve.total.begin());
    EXPECT_NEAR(curve.angle_deg[at], 135.0, 7.5) << "light from 45 degrees goes straight on";
}

} // namespace
} // namespace reradiant
