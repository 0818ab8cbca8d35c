#include "host/fit/synth/synth_band.h"
#include "host/measure/measure_substrate.h"
#include "reradiant/reradiation.h"
#include "reradiant/synth.h"
#include "tests/support/scratch_folder.h"

#include <Eigen/LU>

#include <cmath>
#include <numbers>
#include <stdexcept>

using namespace reradiant;

namespace {

/// One dye far from the ends of the grids.
SynthRecipe plain_recipe() {
    SynthRecipe recipe;
    recipe.fluorophores = {
        {spectrum_of_bands({{.peak_nm = 460, .width_per_cm = 2500, .skew = 0.7}}, 0.8),
         spectrum_of_bands({{.peak_nm = 580, .width_per_cm = 2000, .skew = 1.3}}, 1.0), 0.9}};
    recipe.reflectance = Spectrum::constant(0.15);
    return recipe;
}

/// Mean and variance of (value - noise-free) / sigma over what has a sigma and enough photons.
struct Standardised {
    double mean = 0.0, variance = 0.0, count = 0.0;
};
Standardised standardised(const SynthRecipe& recipe, unsigned seeds) {
    const Eigen::MatrixXd exact = synth_noise_free(recipe)[0];
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        const SynthResult result = synthesise(recipe, seed);
        const BispectralBlock& block = result.data.blocks[0];
        const double one_photon = recipe.noise.shot_counts_at_peak > 0.0
                                      ? result.peak / recipe.noise.shot_counts_at_peak
                                      : 0.0;
        for (Eigen::Index k = 0; k < exact.size(); ++k) {
            const double sigma = block.sigma.reshaped()[k], signal = exact.reshaped()[k];
            if (!(sigma > 1e-12) || signal < 100.0 * one_photon)
                continue;
            const double z = (block.value.reshaped()[k] - signal) / sigma;
            sum += z;
            squares += z * z;
            count += 1.0;
        }
    }
    return {sum / count, squares / count, count};
}

/// Two-sided normal quantile for 8 comparisons at a family-wise rate of 1e-6 (Sidak).
constexpr double sidak_of_8 = 5.29;

void expect_unit_noise(const SynthRecipe& recipe, const char* name) {
    const Standardised seen = standardised(recipe, 12);
    ASSERT_GT(seen.count, 2000.0) << name;
    EXPECT_NEAR(seen.mean, 0.0, sidak_of_8 / std::sqrt(seen.count)) << name;
    // Variance of z^2: 2, and at most 1/100 more for 100 photons. It sees a sigma wrong by 4 %.
    EXPECT_NEAR(seen.variance, 1.0, sidak_of_8 * std::sqrt(2.02 / seen.count)) << name;
}

/// First moment and variance of a column over emission, without its diagonal.
std::array<double, 2> moments(const Eigen::MatrixXd& values, int column) {
    double sum = 0.0, first = 0.0, second = 0.0;
    for (int o = 0; o < values.rows(); ++o) {
        const double nm = 380.0 + 10.0 * o;
        if (nm < 490.0)
            continue;
        sum += values(o, column);
        first += nm * values(o, column);
        second += nm * nm * values(o, column);
    }
    return {first / sum, second / sum - first * first / (sum * sum)};
}

class Synth : public test::ScratchFolder {};

} // namespace

TEST_F(Synth, WithoutNoiseTheDataAreTheTruth) {
    const SynthRecipe recipe = plain_recipe();
    const ReradiationMatrix truth = synth_truth(recipe);
    const SynthResult result = synthesise(recipe, 5);
    ASSERT_EQ(result.data.blocks.size(), 1u);
    EXPECT_EQ(result.data.blocks[0].value, truth.values);
    EXPECT_TRUE(result.data.blocks[0].sigma.isZero(0.0));
    EXPECT_EQ(result.noise_rms, 0.0);
    EXPECT_EQ(result.peak, truth.fluorescent_part().maxCoeff());
    std::vector<std::string> warnings;
    ReradiationMatrix model = truth;
    EXPECT_TRUE(repair_for_rendering(model, warnings).text().empty());
    EXPECT_TRUE(warnings.empty());
}

TEST_F(Synth, SeedsMakeTheData) {
    SynthRecipe recipe = plain_recipe();
    recipe.noise = {.read_of_peak = 0.01, .shot_counts_at_peak = 1e4, .relative = 0.01};
    const Eigen::MatrixXd first = synthesise(recipe, 1).data.blocks[0].value;
    EXPECT_EQ(first, synthesise(recipe, 1).data.blocks[0].value);
    EXPECT_NE(first, synthesise(recipe, 2).data.blocks[0].value);
}

TEST_F(Synth, EveryNoiseHasTheDeviationItSays) {
    SynthRecipe recipe = plain_recipe();
    recipe.noise = {.read_of_peak = 0.01};
    expect_unit_noise(recipe, "read");
    recipe.noise = {.shot_counts_at_peak = 1e5};
    expect_unit_noise(recipe, "shot");
    recipe.noise = {.relative = 0.02};
    expect_unit_noise(recipe, "relative");
    recipe.noise = {.read_of_peak = 0.01, .shot_counts_at_peak = 1e4, .relative = 0.02};
    expect_unit_noise(recipe, "all");
}

TEST_F(Synth, ReadNoiseIsAFractionOfThePeak) {
    SynthRecipe recipe = plain_recipe();
    recipe.noise = {.read_of_peak = 0.05};
    const SynthResult result = synthesise(recipe, 3);
    // 1968 normal numbers: the deviation's own is 1.6 %, five of them.
    EXPECT_NEAR(result.noise_rms / result.peak, 0.05, 5.0 * 0.05 * 0.016);
}

TEST_F(Synth, BareSamplesLookAlikeFromEverywhere) {
    SynthRecipe recipe = plain_recipe();
    recipe.geometries = {{0, 45, 0}, {60, 20, 90}};
    const auto seen = synth_noise_free(recipe);
    ASSERT_EQ(seen.size(), 2u);
    // 1/sr in 12 digits is not involved: only pi times 1/pi.
    for (const Eigen::MatrixXd& values : seen)
        EXPECT_LT((values - synth_truth(recipe).values).cwiseAbs().maxCoeff(), 1e-13);
}

TEST_F(Synth, AStackActsAsTheAddingFormulaSays) {
    SynthRecipe recipe = plain_recipe();
    recipe.emission = recipe.excitation = {400.0, 10.0, 31};
    recipe.stack.layers = {Layer{}}; // n 1.5, smooth, clear
    recipe.geometries = {{0, 0, 90}};
    const Eigen::MatrixXd bare = synth_truth(recipe).values;
    const double r = 0.596346, t = 0.96; // the closed form of adding, Fresnel at normal incidence
    const Eigen::MatrixXd expected =
        t * t / 2.25 * bare * (Eigen::MatrixXd::Identity(31, 31) - r * bare).inverse();
    // r has six digits.
    EXPECT_LT((synth_noise_free(recipe)[0] - expected).cwiseAbs().maxCoeff(), 1e-6);
}

TEST_F(Synth, BandpassesWidenBandsAndKeepTheirPower) {
    SynthRecipe recipe = plain_recipe();
    const Eigen::MatrixXd truth = synth_truth(recipe).values;
    const int column = 12; // 420 nm
    for (const double fwhm : {10.0, 20.0}) {
        recipe.instrument = {.emission_fwhm_nm = fwhm};
        const Eigen::MatrixXd seen = synth_noise_free(recipe)[0];
        EXPECT_NEAR(seen.col(column).tail(30).sum(), truth.col(column).tail(30).sum(),
                    1e-3 * truth.col(column).sum());
        const auto before = moments(truth, column), after = moments(seen, column);
        EXPECT_NEAR(after[0], before[0], 0.05);
        // A triangle has the variance fwhm^2 / 6, a cell step^2 / 12; 2 % for the fine grid.
        const double added = fwhm * fwhm / 6.0 - 100.0 / 12.0;
        EXPECT_NEAR(after[1] - before[1], added, 0.02 * fwhm * fwhm / 6.0 + 0.5) << fwhm;
    }
    recipe.instrument = {.excitation_fwhm_nm = 12.0, .emission_fwhm_nm = 8.0};
    const Eigen::MatrixXd both = synth_noise_free(recipe)[0];
    EXPECT_NEAR(both(40, 48), 0.15, 1e-9); // 780 nm, where nothing fluoresces
    EXPECT_NEAR(both.col(column).tail(30).sum(), truth.col(column).tail(30).sum(),
                0.01 * truth.col(column).sum());
}

TEST_F(Synth, BandpassesWorkUnderAStack) {
    SynthRecipe recipe = plain_recipe();
    recipe.emission = {500.0, 20.0, 8};
    recipe.excitation = {400.0, 20.0, 5};
    recipe.stack.layers = {Layer{}};
    recipe.geometries = {{30, 0, 90}};
    recipe.instrument = {.excitation_fwhm_nm = 20.0, .emission_fwhm_nm = 20.0};
    const Eigen::MatrixXd seen = synth_noise_free(recipe)[0];
    recipe.stack.layers.clear();
    const Eigen::MatrixXd bare = synth_noise_free(recipe)[0];
    // A layer of n = 1.5 leaves the share T(30) T(0) / n^2 / (1 - r rho)^2 over this weak
    // substrate.
    const double share = 0.96 * 0.9585 / 2.25 / std::pow(1.0 - 0.596346 * 0.15, 2);
    EXPECT_NEAR(seen.sum() / bare.sum(), share, 0.01);
}

TEST_F(Synth, SpillLiesBesideTheDiagonal) {
    SynthRecipe recipe = plain_recipe();
    const Eigen::MatrixXd before = synthesise(recipe, 1).data.blocks[0].value;
    recipe.instrument.spill = 0.05;
    const SynthResult result = synthesise(recipe, 1);
    Eigen::MatrixXd added = result.data.blocks[0].value - before;
    for (int i = 0; i < 49; ++i) {
        const int o = i - 8; // emission begins at 380, excitation at 300
        for (const int beside : {o - 1, o + 1})
            if (o >= 0 && o < 41 && beside >= 0 && beside < 41) {
                EXPECT_NEAR(added(beside, i), 0.05 * before(o, i), 1e-15);
                added(beside, i) = 0.0;
            }
    }
    EXPECT_TRUE(added.isZero(1e-15));
    EXPECT_EQ(result.peak, synth_truth(recipe).fluorescent_part().maxCoeff());
}

TEST_F(Synth, DataSurviveTheirFiles) {
    SynthRecipe recipe = plain_recipe();
    recipe.noise = {.read_of_peak = 0.02};
    const BispectralData bare = synthesise(recipe, 9).data;
    write_bispectral_data(path("bare.csv"), bare);
    EXPECT_EQ(read_bispectral_data(path("bare.csv")).blocks[0].value, bare.blocks[0].value);
    recipe.stack.layers = {Layer{}};
    recipe.geometries = {{0, 45, 0}, {45, 10, 180}};
    const BispectralData layered = synthesise(recipe, 9).data;
    write_bispectral_data(path("layered.csv"), layered);
    const BispectralData back = read_bispectral_data(path("layered.csv"));
    ASSERT_EQ(back.blocks.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(back.blocks[k].geometry, layered.blocks[k].geometry);
        // 12 digits of values up to 1.
        EXPECT_TRUE(back.blocks[k].value.isApprox(layered.blocks[k].value, 1e-11));
        EXPECT_TRUE(back.blocks[k].sigma.isApprox(layered.blocks[k].sigma, 1e-11));
    }
}

TEST_F(Synth, ImpossibleRecipesAreRefused) {
    SynthRecipe recipe = plain_recipe();
    recipe.geometries = {{0, 45, 0}};
    recipe.excitation = {305.0, 10.0, 40};
    EXPECT_THROW(synthesise(recipe, 1), std::invalid_argument);
    recipe.excitation = {700.0, 10.0, 5};
    EXPECT_THROW(synthesise(recipe, 1), std::invalid_argument); // nothing fluoresces
    recipe = plain_recipe();
    recipe.instrument.emission_fwhm_nm = 0.5;
    EXPECT_THROW(synthesise(recipe, 1), std::invalid_argument); // 5000 fine bands
}

/// No instrument tells light of dyes in layers from that of the substrate.
TEST_F(Synth, DyesInLayersAreMeasuredWithTheSubstrate) {
    SynthRecipe recipe;
    recipe.emission = recipe.excitation = {400.0, 50.0, 5};
    recipe.reflectance = Spectrum::constant(0.8);
    recipe.geometries = {{45, 0, 0}};
    Layer& layer = recipe.stack.layers.emplace_back();
    layer.dyes.push_back({Spectrum::gaussian(450.0, 30.0, 0.5), 1.0,
                          Spectrum::gaussian(550.0, 30.0, 1.0), 0.9, nullptr});
    const Eigen::MatrixXd seen = synth_noise_free(recipe).at(0);
    MeasureRequest request;
    request.model = Model::Adding;
    request.theta_i_deg = {45};
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(5, 5);
    const Eigen::MatrixXd bare = Eigen::MatrixXd::Identity(5, 5) * 0.8;
    for (const MeasureRow& row : measure_stack(recipe.stack, bare, recipe.emission, request).rows)
        if (row.part != MeasuredPart::Specular)
            expected(recipe.emission.band_of(row.lambda_o_nm),
                     recipe.emission.band_of(row.lambda_i_nm)) += std::numbers::pi * row.value;
    EXPECT_LT((seen - expected).cwiseAbs().maxCoeff(), 1e-14);
    layer.dyes.clear();
    EXPECT_GT(synth_noise_free(recipe).at(0)(1, 1), 1.5 * seen(1, 1)) << "the dye absorbs there";
}
