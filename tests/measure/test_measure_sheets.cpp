#include "host/layers/stack/quadrature.h"
#include "host/measure/geometry_matrix.h"
#include "host/measure/measure_substrate.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"
#include "tests/layers/slab_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace reradiant;
using namespace reradiant::test;

namespace {

/// A smooth sheet whose dye takes light of band 0 to band 1, where it is clear, and of band 2 to
/// itself.
LayerStack concentrator() {
    return {{dyed_layer(1.5, {2, 0, 1}, {0, 0, 0, .9, 0, 0, 0, 0, 1})}, LowerFace{}};
}

Material sheet_of(const LayerStack& stack) {
    Material material;
    material.stack = stack;
    material.substrate.type = SubstrateType::None;
    return material;
}

MeasureRequest by_walk(const std::vector<double>& theta_i, bool hemispherical) {
    MeasureRequest request;
    request.model = Model::Walk;
    request.theta_i_deg = theta_i;
    request.hemispherical = hemispherical;
    request.samples = 1 << 13;
    return request;
}

std::map<MeasuredPart, int> rows_by_part(const Measurement& measurement) {
    std::map<MeasuredPart, int> count;
    for (const MeasureRow& row : measurement.rows)
        ++count[row.part];
    return count;
}

} // namespace

TEST(MeasureSheets, HemisphericalRowsHoldBothSidesAndWhatIsGuided) {
    const Measurement found = measure_material(sheet_of(concentrator()), by_walk({30, 150}, true));
    EXPECT_EQ(found.bands, three_bands); // of the dye's shares
    EXPECT_TRUE(found.of_sheet);
    const std::map<MeasuredPart, int> expected{{MeasuredPart::Slab, 12},
                                               {MeasuredPart::Specular, 6},
                                               {MeasuredPart::Transmitted, 12},
                                               {MeasuredPart::TransmittedSpecular, 6},
                                               {MeasuredPart::Guided, 12}};
    EXPECT_EQ(rows_by_part(found), expected);
    for (const MeasureRow& row : found.rows) {
        const bool may_hold = row.part == MeasuredPart::Specular ||
                              row.part == MeasuredPart::TransmittedSpecular ||
                              (row.lambda_i_nm == 400 && row.lambda_o_nm == 450) ||
                              (row.lambda_i_nm == 500 && row.part != MeasuredPart::Guided);
        EXPECT_EQ(row.value > 0.0, may_hold)
            << part_name(row.part) << " " << row.lambda_i_nm << " to " << row.lambda_o_nm;
    }
}

TEST(MeasureSheets, BalancesAreThoseOfAllParts) {
    const Measurement found = measure_material(sheet_of(concentrator()), by_walk({0, 120}, true));
    const std::vector<MeasuredBalance> balances = measured_balances(found);
    ASSERT_EQ(balances.size(), 2U);
    EXPECT_EQ(balances[0].theta_i_deg, 0.0);
    EXPECT_EQ(balances[1].theta_i_deg, 120.0);
    for (const MeasuredBalance& one : balances) {
        // band 0 loses a tenth of what its dye absorbs and gains photons; the others lose nothing
        EXPECT_NEAR(one.largest_energy, 1.0, 1e-12);
        EXPECT_GT(one.smallest_energy, 0.9);
        EXPECT_LT(one.smallest_energy, 0.95);
        EXPECT_NEAR(one.smallest_photons, 1.0, 1e-12);
        const double absorbed = 10.0 * (1.0 - one.smallest_energy);
        EXPECT_NEAR(one.largest_photons, 1.0 - absorbed + 0.9 * absorbed * 450.0 / 400.0, 1e-12);
    }
    EXPECT_TRUE(
        measured_balances(measure_material(sheet_of(concentrator()), by_walk({0}, false))).empty());
}

TEST(MeasureSheets, DirectionalRowsSeeTheFarSide) {
    LayerStack stack = concentrator();
    stack.layers[0].alpha = 0.3;
    MeasureRequest request = by_walk({30, 150}, false);
    request.theta_o_deg = {20, 160};
    request.phi_deg = {180};
    const Measurement found = measure_material(sheet_of(stack), request);
    std::map<std::pair<double, double>, double> shifted;
    for (const MeasureRow& row : found.rows) {
        EXPECT_TRUE(row.part == MeasuredPart::Slab || row.part == MeasuredPart::Specular);
        if (row.lambda_i_nm == 400 && row.lambda_o_nm == 450)
            shifted[{row.theta_i_deg, row.theta_o_deg}] += row.value;
    }
    ASSERT_EQ(shifted.size(), 4U);
    for (const auto& [angles, value] : shifted)
        EXPECT_GT(value, 0.0) << angles.first << " " << angles.second;
}

TEST(MeasureSheets, ANoteTellsTheErrorOfTheDepthCells) {
    MeasureRequest request = by_walk({0}, true);
    request.model = Model::Adding;
    const auto tells = [&](const LayerStack& stack) {
        const Measurement found = measure_material(sheet_of(stack), request);
        return std::ranges::any_of(found.notes, [](const std::string& note) {
            return note.find("cells of depth") != std::string::npos;
        });
    };
    EXPECT_TRUE(tells(concentrator()));
    EXPECT_FALSE(tells({{{}}, LowerFace{}}));
}

TEST(MeasureSheets, Case60RowsOfADyeOfConcentrationZeroAreThoseOfNone) {
    Layer dyed = dyed_layer(1.5, {1, .4, 0}, {0, 0, 0, .5, 0, 0, .2, .7, 0}), plain = dyed;
    dyed.dyes[0].concentration = 0.0;
    plain.dyes.clear();
    for (const bool is_sheet : {true, false})
        for (const bool hemispherical : {true, false}) {
            const auto rows_of = [&](const Layer& layer) {
                Material material;
                material.stack = {{layer}};
                if (is_sheet)
                    material = sheet_of({{layer}, LowerFace{}});
                MeasureRequest request;
                request.hemispherical = hemispherical;
                request.theta_i_deg = {0, 40};
                request.theta_o_deg = {20};
                return measure_material(material, request);
            };
            const Measurement with = rows_of(dyed), without = rows_of(plain);
            ASSERT_EQ(with.rows.size(), without.rows.size());
            EXPECT_EQ(with.bands, without.bands);
            EXPECT_EQ(with.notes, without.notes);
            for (std::size_t k = 0; k < with.rows.size(); ++k) {
                EXPECT_EQ(with.rows[k].value, without.rows[k].value);
                EXPECT_EQ(with.rows[k].part, without.rows[k].part);
            }
        }
}

TEST(MeasureSheets, AnglesAreThoseOfTheMaterialsSides) {
    const auto refusal = [](const Material& material, double theta_i, double theta_o) {
        MeasureRequest request = by_walk({theta_i}, false);
        request.theta_o_deg = {theta_o};
        try {
            measure_material(material, request);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    Material opaque;
    opaque.stack = {{dyed_layer(1.5, {1, 0, 0}, std::vector<double>(9, 0.0))}};
    EXPECT_NE(refusal(opaque, 20, 120).find("beneath the material, which is opaque"),
              std::string::npos);
    EXPECT_NE(refusal(opaque, 120, 20).find("opaque"), std::string::npos);
    EXPECT_NE(refusal(opaque, 20, 90).find("below 90"), std::string::npos);
    const Material sheet = sheet_of(concentrator());
    EXPECT_NE(refusal(sheet, 90, 0).find("along the sheet"), std::string::npos);
    EXPECT_NE(refusal(sheet, 20, 90).find("theta-o of 90"), std::string::npos);
    EXPECT_NE(refusal(sheet, 180.5, 0).find("out of range"), std::string::npos);
    EXPECT_EQ(refusal(sheet, 180, 0), "");
}

TEST(MeasureSheets, ScatteredLightIsThatOfTheSlabOverASubstrate) {
    Layer milky = dyed_layer(1.5, {0, 0, 0}, std::vector<double>(9, 0.0));
    milky.dyes.clear();
    milky.scattering_coefficient = Spectrum::constant(1.0);
    MeasureRequest request = by_walk({30}, true);
    const Eigen::MatrixXd black = Eigen::MatrixXd::Zero(3, 3);
    const Measurement cloudy = measure_stack({{milky}}, black, three_bands, request);
    const std::map<MeasuredPart, int> expected{
        {MeasuredPart::Diffuse, 3}, {MeasuredPart::Slab, 3}, {MeasuredPart::Specular, 3}};
    EXPECT_EQ(rows_by_part(cloudy), expected);
    for (const MeasureRow& row : cloudy.rows)
        if (row.part == MeasuredPart::Specular) // Fresnel's reflection alone
            EXPECT_NEAR(row.value, 0.0415, 5.0 * row.standard_error + 1e-4);
        else
            EXPECT_EQ(row.value > 0.1, row.part == MeasuredPart::Slab);
}

TEST(MeasureSheets, DiffuseIlluminationOfADyeIsItsClosedForm) {
    const double depth = 0.7, share = 0.8;
    Material material =
        sheet_of({{dyed_layer(1.0, {depth, 0, 0}, {0, 0, 0, share, 0, 0, 0, 0, 0})}, LowerFace{}});
    material.model = Model::Walk;
    const Eigen::MatrixXd seen = geometry_matrix(material, viewing_geometry("d/8")).values;
    // what each incidence absorbs is sent out over the sphere, of which 8 degrees see 1 / cos
    const double absorbed =
        2.0 * integrate_sin2(0.0, 1.0, 64, [&](double c) { return c * -std::expm1(-depth / c); });
    const double expected = absorbed * share / (4.0 * std::cos(8.0 * M_PI / 180.0));
    EXPECT_NEAR(seen(1, 0), expected, 0.02 * expected); // 65536 walks
    EXPECT_EQ(seen(0, 1), 0.0);
    const Eigen::MatrixXd there = geometry_matrix(material, viewing_geometry("8/d")).values;
    EXPECT_NEAR(there(1, 0), -std::expm1(-depth / std::cos(8.0 * M_PI / 180.0)) * share / 2.0,
                0.02 * there(1, 0));
}
