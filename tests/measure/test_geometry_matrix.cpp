#include "host/measure/geometry_matrix.h"

#include "reradiant/measure.h"
#include "reradiant/scene_file.h"
#include "tests/measure/smooth_slabs.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <stdexcept>

using namespace reradiant;

namespace {

Material preset(const std::string& name) {
    return load_material(std::filesystem::path(RERADIANT_SOURCE_DIR) / "spectra" / "materials" /
                         (name + ".toml"));
}

Eigen::MatrixXd factors(const Material& material, const std::string& geometry) {
    return geometry_matrix(material, viewing_geometry(geometry)).values;
}

/// Radiance factors of all diffuse light that comes from everywhere and is seen at 8 degrees:
/// Gauss-Legendre's rule of 5 points on pieces of the squared sine.
Eigen::MatrixXd by_quadrature(const Material& material) {
    constexpr std::array<double, 5> x = {0.04691007703066802, 0.23076534494715845, 0.5,
                                         0.7692346550528415, 0.9530899229693319};
    constexpr std::array<double, 5> w = {0.11846344252809454, 0.23931433524968324,
                                         0.28444444444444444, 0.23931433524968324,
                                         0.11846344252809454};
    constexpr int pieces = 12;
    MeasureRequest request;
    request.theta_o_deg = {8.0};
    request.phi_deg = {90.0};
    request.theta_i_deg.clear();
    for (int piece = 0; piece < pieces; ++piece)
        for (const double node : x) {
            // Towards grazing incidence the transmission has a root's slope: cos = v squared.
            const double v = (piece + node) / pieces;
            request.theta_i_deg.push_back(std::acos(v * v) * 180.0 / std::numbers::pi);
        }
    const Measurement measured = measure_material(material, request);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(measured.bands.count, measured.bands.count);
    for (const MeasureRow& row : measured.rows) {
        if (row.part != MeasuredPart::Diffuse && row.part != MeasuredPart::Slab)
            continue;
        const double cosine = std::cos(row.theta_i_deg * std::numbers::pi / 180.0);
        const double v = std::sqrt(cosine) * pieces;
        const double place = v - std::floor(v);
        std::size_t node = 0;
        for (std::size_t k = 1; k < 5; ++k)
            if (std::abs(x[k] - place) < std::abs(x[node] - place))
                node = k;
        // 2 pi cos d(cos), and d(cos) = 2 v dv.
        sum(measured.bands.band_of(row.lambda_o_nm), measured.bands.band_of(row.lambda_i_nm)) +=
            2.0 * std::numbers::pi * cosine * 2.0 * std::sqrt(cosine) * w[node] / pieces *
            row.value;
    }
    return sum;
}

/// Three bands, of which the first excites both others and the second the third.
Material over_stokes_shift(const LayerStack& stack) {
    Material material;
    material.stack = stack;
    const Eigen::MatrixXd values = test::stokes_matrix();
    material.substrate.reflectance =
        Spectrum::table({400.0, 500.0, 600.0}, {values(0, 0), values(1, 1), values(2, 2)});
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = test::grid;
    matrix.values = values;
    material.substrate.matrix = std::make_shared<const ReradiationMatrix>(std::move(matrix));
    return material;
}

/// A smooth slab with a dye that sends light on by the Stokes shift, on the same bands.
LayerStack dyed_slab(double ior) {
    LayerStack stack = test::stack_of({{1.0, ior}, {0.0, 0.1}});
    ReradiationMatrix shares;
    shares.emission = shares.excitation = test::grid;
    shares.values = test::stokes_matrix();
    stack.layers[0].dyes = {{Spectrum::table({400.0, 500.0, 600.0}, {2.0, 0.7, 0.2}),
                             1.0,
                             {},
                             1.0,
                             std::make_shared<const ReradiationMatrix>(std::move(shares))}};
    return stack;
}

Material sheet_of(LayerStack stack) {
    Material sheet;
    sheet.stack = std::move(stack);
    sheet.stack.lower_face.emplace();
    sheet.substrate.type = SubstrateType::None;
    return sheet;
}

double largest_error(const Eigen::MatrixXd& seen, const Eigen::MatrixXd& expected) {
    return (seen - expected).cwiseAbs().maxCoeff();
}

LayerStack rough_coat(double alpha, Distribution distribution, double ior) {
    LayerStack stack = test::stack_of({{1.0, ior}, {0.0, 0.1}});
    stack.layers[0].alpha = alpha;
    stack.layers[0].distribution = distribution;
    return stack;
}

/// Sums of what a walk with one seed reflects and re-radiates in a geometry, in its bands' order:
/// reflected, re-radiated.
std::array<double, 2> walked_sums(const Material& material, const ViewingGeometry& geometry,
                                  long samples, unsigned seed) {
    MeasureRequest request;
    request.model = Model::Walk;
    request.theta_i_deg = {geometry.theta_i_deg};
    request.theta_o_deg = {geometry.theta_o_deg};
    request.phi_deg = {geometry.phi_deg};
    request.hemispherical = geometry.kind != ViewingGeometry::Kind::Directional;
    request.samples = samples;
    request.seed = seed;
    std::array<double, 2> sums{};
    for (const MeasureRow& row : measure_material(material, request).rows)
        sums[row.lambda_i_nm == row.lambda_o_nm ? 0 : 1] += row.value;
    for (double& sum : sums)
        sum *= request.hemispherical ? 1.0 : std::numbers::pi;
    return sums;
}

/// The walk's mean over seeds is within three of its standard errors of the closed model's sums.
void expect_walk_agrees(const Material& material, const std::string& name, long samples) {
    constexpr unsigned seeds = 16;
    const ViewingGeometry geometry = viewing_geometry(name);
    const Eigen::MatrixXd closed = geometry_matrix(material, geometry).values;
    const std::array<double, 2> expected{closed.trace(), closed.sum() - closed.trace()};
    std::array<double, 2> mean{}, square{};
    for (unsigned seed = 0; seed < seeds; ++seed) {
        const std::array<double, 2> seen = walked_sums(material, geometry, samples, seed);
        for (std::size_t k = 0; k < 2; ++k) {
            mean[k] += seen[k] / seeds;
            square[k] += seen[k] * seen[k] / seeds;
        }
    }
    for (std::size_t k = 0; k < 2; ++k) {
        const double error = std::sqrt((square[k] - mean[k] * mean[k]) / (seeds - 1));
        EXPECT_LT(std::abs(mean[k] - expected[k]), 3.0 * error)
            << name << (k == 0 ? ", reflected " : ", re-radiated ") << mean[k] << " +- " << error
            << ", closed " << expected[k];
        EXPECT_LT(error, 0.02 * expected[k]) << "too noisy to tell anything";
    }
}

} // namespace

TEST(GeometryMatrix, NamesAreRead) {
    EXPECT_EQ(viewing_geometry("45/0").theta_i_deg, 45.0);
    EXPECT_EQ(viewing_geometry("0/45").theta_o_deg, 45.0);
    EXPECT_FALSE(viewing_geometry("8/de").specular_included);
    EXPECT_EQ(viewing_geometry("20:60:180").phi_deg, 180.0);
    for (const char* text : {"", "45", "45/8", "90:0", "0:90", "-1:0", "1:2:3:4", "a:b",
                             "45:", ":0", "nan:0", "45:0:x"})
        EXPECT_THROW(viewing_geometry(text), std::invalid_argument) << text;
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            viewing_geometry(text);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(refusal("45/8").find("8/de"), std::string::npos) << "lists those that there are";
    EXPECT_NE(refusal("95:0").find("below the horizon"), std::string::npos) << refusal("95:0");
    EXPECT_NE(refusal("20:-5").find("negative"), std::string::npos) << refusal("20:-5");
    EXPECT_NE(refusal("0:180").find("of what is reflected"), std::string::npos) << refusal("0:180");
}

TEST(GeometryMatrix, BareMaterialIsItsMatrixInEveryGeometry) {
    const Material bare = preset("neon-orange-bare");
    const Eigen::MatrixXd expected = factors(bare, "45/0");
    for (const char* geometry : {"0/45", "8/d", "d/8", "8/de", "de/8", "20:60:90"})
        EXPECT_LT((factors(bare, geometry) - expected).cwiseAbs().maxCoeff(), 1e-12) << geometry;
}

// A varnished sample at 45/0: light goes in at 45 degrees at its own wavelength and out at 0 at the
// wavelength of emission, so that 0/45 is the transpose where the substrate's matrix is transposed,
// and differs from 45/0 by transmissions alone.
TEST(GeometryMatrix, DirectionalIsWhatMeasureSays) {
    const Material varnished = preset("neon-orange-varnished");
    MeasureRequest request;
    request.theta_i_deg = {45.0};
    const Measurement measured = measure_material(varnished, request);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(measured.bands.count, measured.bands.count);
    for (const MeasureRow& row : measured.rows)
        expected(measured.bands.band_of(row.lambda_o_nm),
                 measured.bands.band_of(row.lambda_i_nm)) += std::numbers::pi * row.value;
    EXPECT_LT((factors(varnished, "45/0") - expected).cwiseAbs().maxCoeff(), 1e-12);
}

// The transposed material seen from 8 degrees, against the integral over incident directions; the
// surface's own reflection is that of 8/d. The rule's error is below 1e-6.
TEST(GeometryMatrix, DiffuseIlluminationIsTheIntegralOverIncidence) {
    const Material varnished = preset("neon-orange-varnished");
    const Eigen::MatrixXd expected = by_quadrature(varnished);
    const Eigen::MatrixXd excluded = factors(varnished, "de/8");
    EXPECT_LT((excluded - expected).cwiseAbs().maxCoeff(), 1e-6);
    const Eigen::MatrixXd mirror = factors(varnished, "d/8") - excluded;
    EXPECT_LT(
        (mirror - (factors(varnished, "8/d") - factors(varnished, "8/de"))).cwiseAbs().maxCoeff(),
        1e-12);
    EXPECT_TRUE(mirror.isDiagonal(1e-12));
    EXPECT_GT(mirror(0, 0), 0.03);
    EXPECT_LT(mirror(0, 0), 0.06);
}

// At 8 degrees Fresnel's reflectance of a smooth IOR of 1.5 is 0.04 to four digits, all of it in
// the mirror; of a surface so rough that its lobe is far wider than the port, little is excluded.
TEST(GeometryMatrix, ThePortTakesAwayWhatTheLobePutsThere) {
    Material smooth = preset("fluorescent-orange-smooth"),
             rough = preset("fluorescent-orange-rough");
    const auto excluded = [](const Material& material) {
        return (factors(material, "8/d") - factors(material, "8/de")).eval();
    };
    EXPECT_NEAR(excluded(smooth)(20, 20), 0.04, 0.005);
    EXPECT_GT(excluded(rough)(20, 20), 0.0);
    EXPECT_LT(excluded(rough)(20, 20), excluded(smooth)(20, 20));
    EXPECT_TRUE(excluded(rough).isDiagonal(1e-12));
}

// Light goes in through the stack, is shared out by the substrate and the stack above it in every
// order of interreflection, and goes out through the stack.
TEST(GeometryMatrix, SmoothStacksAgreeWithTheClosedForm) {
    for (const test::SmoothSlabs& slabs : {test::SmoothSlabs{{1.0}, {0.0}},
                                           {{1.0, 1.5}, {0.0, 0.0}},
                                           {{1.0, 1.5}, {0.0, 0.3}},
                                           {{1.0, 1.3, 1.6}, {0.0, 0.0, 0.2}},
                                           {{1.0, 1.6, 1.3}, {0.0, 0.1, 0.2}}}) {
        const Material material = over_stokes_shift(test::stack_of(slabs));
        const Eigen::MatrixXd centre =
            test::interreflected(test::stokes_matrix(), slabs.internal());
        const double n2 = slabs.ior.back() * slabs.ior.back();
        const Eigen::MatrixXd directional =
            slabs.transmission(45.0) * slabs.transmission(0.0) / n2 * centre;
        EXPECT_LT(largest_error(factors(material, "45/0"), directional), 1e-6);
        EXPECT_LT(largest_error(factors(material, "0/45"), directional), 1e-6);
        const Eigen::MatrixXd diffuse = slabs.transmission(8.0) * slabs.external() * centre;
        EXPECT_LT(largest_error(factors(material, "8/de"), diffuse), 1e-6);
        EXPECT_LT(largest_error(factors(material, "de/8"), diffuse), 1e-6);
        const Eigen::MatrixXd all = diffuse + slabs.specular(8.0) * Eigen::MatrixXd::Identity(3, 3);
        EXPECT_LT(largest_error(factors(material, "8/d"), all), 1e-6);
        EXPECT_LT(largest_error(factors(material, "d/8"), all), 1e-6);
    }
}

TEST(GeometryMatrix, RoughStacksAgreeWithTheWalk) {
    const long samples = 1L << (test::is_full_run() ? 15U : 11U);
    for (const LayerStack& stack :
         {rough_coat(0.1, Distribution::Ggx, 1.5), rough_coat(0.3, Distribution::Beckmann, 1.7)})
        for (const char* geometry : {"45/0", "8/d", "30:60:120"})
            expect_walk_agrees(over_stokes_shift(stack), geometry, samples);
}

// Nothing is absorbed, so that all light comes back; the interreflections are summed in closed
// form.
TEST(GeometryMatrix, AWhiteLosslessStackSendsAllBack) {
    Material white = preset("glossy-paint");
    white.substrate.reflectance = Spectrum::constant(1.0);
    const auto off = [&](const char* geometry) {
        const Eigen::MatrixXd values = factors(white, geometry);
        return (values - Eigen::MatrixXd::Identity(values.rows(), values.cols()))
            .cwiseAbs()
            .maxCoeff();
    };
    EXPECT_LT(off("8/d"), 1e-6);
    EXPECT_LT(off("d/8"), 1e-6);
}

// A sheet in air is the same as one over black: what passes it meets nothing. n = 1.5 reflects 0.04
// at each face, and 2 * 0.04 / 1.04 from both.
TEST(GeometryMatrix, ASheetReflectsFromBothFaces) {
    Material sheet;
    sheet.stack.layers.emplace_back();
    sheet.stack.lower_face.emplace();
    sheet.substrate.type = SubstrateType::None;
    const Eigen::MatrixXd values = factors(sheet, "0:0");
    EXPECT_EQ(values.cwiseAbs().maxCoeff(), 0.0) << "a mirror's reflection has no direction";
    const Eigen::MatrixXd at_8_degrees = factors(sheet, "8/d");
    EXPECT_NEAR(at_8_degrees(0, 0), 2.0 * 0.04 / 1.04, 1e-4) << "at 8 degrees hardly more";
    EXPECT_LT(largest_error(factors(sheet, "d/8"), at_8_degrees), 1e-12);
}

// What dyes send out before it reaches the substrate is reflected too. 1e-12: rounding.
TEST(GeometryMatrix, HemisphericalGeometriesHoldTheLightOfDyes) {
    for (const Material& material : {over_stokes_shift(dyed_slab(1.5)), sheet_of(dyed_slab(1.5))}) {
        MeasureRequest request;
        request.theta_i_deg = {8.0};
        request.hemispherical = true;
        const Measurement measured = measure_material(material, request);
        Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, 3);
        for (const MeasureRow& row : measured.rows)
            if (is_reflected(row.part))
                expected(measured.bands.band_of(row.lambda_o_nm),
                         measured.bands.band_of(row.lambda_i_nm)) += row.value;
        EXPECT_LT(largest_error(factors(material, "8/d"), expected), 1e-12);
        EXPECT_GT(factors(material, "8/d")(1, 0), 0.01);
    }
}

// Light from everywhere upon dyes, against the integral over incident directions, whose error is
// below 1e-6; the mirror's reflection is that of 8/d.
TEST(GeometryMatrix, DyesAreLitFromEverywhere) {
    for (const double ior : {1.0, 1.5})
        for (const Material& material :
             {over_stokes_shift(dyed_slab(ior)), sheet_of(dyed_slab(ior))}) {
            const Eigen::MatrixXd excluded = factors(material, "de/8");
            EXPECT_LT(largest_error(excluded, by_quadrature(material)), 3e-6) << ior;
            EXPECT_LT(largest_error(factors(material, "d/8") - excluded,
                                    factors(material, "8/d") - factors(material, "8/de")),
                      1e-12)
                << ior;
        }
}

// What slabs scatter is no specular light, so that the port takes none of it away. Clouds are
// computed on cells of direction: 1e-5.
TEST(GeometryMatrix, CloudyDyesAreLitFromEverywhere) {
    LayerStack cloudy = dyed_slab(1.5);
    cloudy.layers[0].scattering_coefficient = Spectrum::constant(2.0);
    for (const Material& material : {over_stokes_shift(cloudy), sheet_of(cloudy)})
        EXPECT_LT(largest_error(factors(material, "de/8"), by_quadrature(material)), 1e-5);
}

TEST(GeometryMatrix, WalksDoNotExcludeSpecularLight) {
    Material walked = sheet_of({});
    walked.stack.layers.emplace_back().flakes = Flakes{0.2, {}};
    EXPECT_THROW(factors(walked, "8/de"), Error);
    EXPECT_LT(largest_error(factors(walked, "d/8"), factors(walked, "8/d")), 1e-12);
}

TEST(GeometryMatrix, BandsAreThoseOfTheSharesWhereTheSubstrateHasNone) {
    Material dyed;
    Layer& layer = dyed.stack.layers.emplace_back();
    EXPECT_EQ(measured_bands(dyed, {}), grid_from_range(380, 780, 10));
    layer.dyes.push_back(
        {Spectrum::constant(1.0), 1.0, Spectrum::gaussian(600.0, 20.0, 1.0), 0.9, nullptr});
    EXPECT_EQ(measured_bands(dyed, {}), grid_from_range(300, 780, 10));
    const WavelengthGrid own = grid_from_range(400, 600, 50);
    layer.dyes[0].shares = std::make_shared<const ReradiationMatrix>(
        ReradiationMatrix{own, own, Eigen::MatrixXd::Identity(5, 5)});
    EXPECT_EQ(measured_bands(dyed, {}), own);
    dyed.substrate.matrix = std::make_shared<const ReradiationMatrix>(
        ReradiationMatrix{{400, 40, 2}, {400, 40, 2}, Eigen::MatrixXd::Identity(2, 2)});
    EXPECT_THROW(measured_bands(dyed, {}), Error);
}
