#include "host/spectral/colour/lamp.h"
#include "host/spectral/covariance/colour_intervals.h"
#include "reradiant/error.h"
#include "reradiant/synth.h"
#include "tests/fit/fit_cases.h"
#include "tests/support/full_run.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace reradiant;

namespace {

/// Bands of 20 nm keep a fit under a tenth of a second.
constexpr double step_nm = 20.0;

/// Reflects a share of what the dyes leave, less at short wavelengths.
Spectrum paper_around(const std::vector<Fluorophore>& dyes, double share) {
    std::vector<double> nm, left;
    for (double l = 250.0; l <= 850.0; l += 1.0) {
        double absorbed = 0.0;
        for (const Fluorophore& dye : dyes)
            absorbed += dye.excitation(l);
        nm.push_back(l);
        left.push_back(share * (1.0 - absorbed) * (1.0 - 0.3 * std::exp(-(l - 250.0) / 150.0)));
    }
    return Spectrum::table(nm, left);
}

/// Every second set has noise that is the same everywhere.
bool is_noise_even(unsigned seed) {
    return seed % 2 == 0;
}

/// One to three ordinary dyes, or a brightened white, measured with noise that is the same
/// everywhere or, every second time, grows with the signal.
SynthRecipe random_recipe(unsigned seed) {
    std::mt19937 random(seed);
    SynthRecipe recipe;
    recipe.emission = {380.0, step_nm, 21};
    recipe.excitation = {300.0, step_nm, 25};
    const int dyes = 1 + static_cast<int>(seed % 3);
    for (const TestFluorophore& dye : random_fluorophores(random, dyes))
        recipe.fluorophores.push_back(as_fluorophore(dye));
    if (seed % 4 == 3)
        recipe.fluorophores = {as_fluorophore({370.0, 22.0, 0.6, 440.0, 22.0, 0.8})};
    recipe.reflectance = paper_around(recipe.fluorophores, uniform(random, 0.3, 0.95));
    recipe.noise.read_of_peak = std::pow(10.0, uniform(random, -3.0, -1.3));
    if (!is_noise_even(seed))
        recipe.noise.relative = uniform(random, 0.0, 0.01);
    return recipe;
}

/// How many intervals of L*, a* and b* hold the truth, of those of linearisation and of draws.
struct Held {
    int sets = 0;
    std::array<int, 3> linearised{}, drawn{};

    void count(const ColourReport& found, const std::array<double, 3>& truth) {
        ++sets;
        const auto take = [&](const std::vector<QuantityInterval>& list, std::array<int, 3>& held) {
            for (const QuantityInterval& one : list)
                for (std::size_t c = 0; one.name == "Lab" && c < 3; ++c)
                    held[c] += one.low[c] <= truth[c] && truth[c] <= one.high[c] ? 1 : 0;
        };
        take(found.intervals->linearised, linearised);
        take(found.intervals->drawn, drawn);
    }
    double percent(const std::array<int, 3>& held) const {
        return 100.0 * (held[0] + held[1] + held[2]) / (3.0 * sets);
    }
};

void count_set(unsigned seed, bool is_told, const std::vector<Lamp>& lamps,
               std::vector<Held>& held) {
    const SynthRecipe recipe = random_recipe(seed);
    const ReradiationMatrix truth = synth_truth(recipe);
    BispectralData data = synthesise(recipe, seed).data;
    if (!is_told) // as a re-radiation CSV has them
        data.blocks.front().sigma.setConstant(not_measured);
    FitSettings settings;
    settings.covariance = true;
    settings.threads = 1;
    const FitResult fit = fit_reradiation(data, settings);
    ASSERT_TRUE(fit.failure.empty()) << seed << ": " << fit.failure;
    for (std::size_t k = 0; k < lamps.size(); ++k) {
        ColourReport found = colour_report(fit.matrix, lamps[k], ColourSum::Bands);
        set_intervals(found, fit.matrix, *fit.covariance, lamps[k], ColourSum::Bands, seed);
        held[k].count(found, colour_report(truth, lamps[k], ColourSum::Bands).colour.lab);
    }
}

void print(const std::string& name, const Held& held) {
    fmt::print("{}: of {} sets, intervals by linearisation hold {:.1f} % (L* {:.1f}, a* {:.1f}, b* "
               "{:.1f}), by draws {:.1f} %\n",
               name, held.sets, held.percent(held.linearised),
               100.0 * held.linearised[0] / held.sets, 100.0 * held.linearised[1] / held.sets,
               100.0 * held.linearised[2] / held.sets, held.percent(held.drawn));
}

} // namespace

// Of 600 intervals 90 to 99 % hold the truth, where the noise is told or the same everywhere. Those
// of one set are wrong together: with a tenth of the sets the limits are wider.
TEST(ColourCoverage, IntervalsOfFitsHoldTheTruth) {
    const int sets = test::is_full_run() ? 200 : 12;
    const double least = test::is_full_run() ? 90.0 : 75.0;
    const double most = test::is_full_run() ? 99.0 : 100.0;
    const std::vector<Lamp> lamps{lamp_from_text("D65"), lamp_from_text("A")};
    std::vector<Held> held(lamps.size());
    for (int set = 0; set < sets; ++set) {
        const auto seed = static_cast<unsigned>(set);
        count_set(seed, !is_noise_even(seed) || seed % 4 == 0, lamps, held);
    }
    for (std::size_t k = 0; k < lamps.size(); ++k) {
        print(lamps[k].name, held[k]);
        for (const auto& list : {held[k].linearised, held[k].drawn}) {
            EXPECT_GE(held[k].percent(list), least) << lamps[k].name;
            EXPECT_LE(held[k].percent(list), most) << lamps[k].name;
        }
    }
}

// An estimate takes the noise of the fluorescence for the same everywhere, which it is not. That of
// the diagonal, where it is largest, is looked at by itself: without that half of the intervals
// miss.
TEST(ColourCoverage, IntervalsHoldTheTruthWhereUnevenNoiseIsNotTold) {
    if (!test::is_full_run())
        GTEST_SKIP() << "a full run measures it";
    const std::vector<Lamp> lamps{lamp_from_text("D65"), lamp_from_text("A")};
    std::vector<Held> held(lamps.size());
    for (unsigned seed = 1; seed < 200; seed += 2)
        count_set(seed, false, lamps, held);
    for (std::size_t k = 0; k < lamps.size(); ++k) {
        print(lamps[k].name + ", uneven noise that is not told", held[k]);
        EXPECT_GE(held[k].percent(held[k].linearised), 85.0);
    }
}

// The fit's own standard errors and those of its covariance are the same, but for what the bound at
// zero adds.
TEST(FitCovariance, HoldsTheStandardErrorsOfTheEntries) {
    const ReradiationMatrix truth =
        true_matrix(two_fluorophores(), {380.0, step_nm, 21}, {300.0, step_nm, 25});
    FitSettings settings;
    settings.rank = 2;
    settings.covariance = true;
    const FitResult fit = fit_reradiation(noisy_data(truth, 1e-4, true, 5), settings);
    const Eigen::ArrayXXd told = fit.covariance->standard_errors(), own = fit.sigma;
    EXPECT_TRUE((told >= own * (1.0 - 1e-6)).all());
    EXPECT_LT((told - own).abs().sum(), 0.2 * own.sum());
    EXPECT_EQ(*fit.covariance->matrix, fit.matrix.values);
    EXPECT_FALSE(fit_reradiation(noisy_data(truth, 1e-4, true, 5), {}).covariance.has_value());
    settings.rank.reset();
    settings.model = FitModel::Matrix;
    EXPECT_THROW(fit_reradiation(noisy_data(truth, 1e-4, true, 5), settings), Error);
}

// Where the noise of a diagonal is larger than that of the fluorescence, from which noise is
// estimated, its errors are its own.
TEST(FitCovariance, KnowsTheNoiseOfTheDiagonal) {
    const ReradiationMatrix truth = true_matrix({two_fluorophores()[0]});
    BispectralData data = noisy_data(truth, 1e-4, false, 3);
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (int i = 8; i < 49; ++i)
        data.blocks.front().value(i - 8, i) += 2e-3 * normal(random);
    FitSettings settings;
    settings.covariance = true;
    const FitResult fit = fit_reradiation(data, settings);
    EXPECT_LT(fit.noise, 2e-4);
    // An estimate from 41 entries is off by a fifth.
    EXPECT_NEAR(fit.covariance->independent(20, 28) / 2e-3, 1.0, 0.5);
    const FitResult even = fit_reradiation(noisy_data(truth, 1e-4, false, 3), settings);
    EXPECT_NEAR(even.covariance->independent(20, 28) / even.noise, 1.0, 0.1);
}
