#include "host/fit/data/fit_mask.h"
#include "host/fit/result/fit_summary.h"
#include "reradiant/error.h"
#include "reradiant/fit.h"
#include "tests/film/film_fixtures.h"
#include "tests/fit/fit_cases.h"
#include "tests/spectral/scatter_cases.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace reradiant;

namespace {

const std::filesystem::path inputs =
    std::filesystem::path(RERADIANT_SOURCE_DIR) / "tests" / "fit" / "inputs";

FitResult fit(const BispectralData& data, const std::string& mask,
              std::optional<int> rank = std::nullopt) {
    FitSettings settings;
    settings.mask = mask_rules_from_text(mask);
    settings.rank = rank;
    const FitResult result = fit_reradiation(data, settings);
    EXPECT_EQ(result.failure, "");
    return result;
}

/// Two dyes with a line of scatter, and the same without it.
struct ScatteredData {
    ReradiationMatrix truth = true_matrix(two_fluorophores());
    double peak = stokes_peak(truth), noise = 0.01 * peak;
    BispectralData clean, scattered;

    ScatteredData(double ratio, double height, double fwhm_nm, bool tell = false) {
        ReradiationMatrix line = truth;
        line.values.setZero();
        add_scatter(line, ratio, height * peak, fwhm_nm);
        clean = scattered = noisy_data(truth, noise, tell, 1);
        scattered.blocks[0].value += line.values;
    }
};

} // namespace

TEST(MaskRules, AreReadAndWrittenAlike) {
    EXPECT_EQ(mask_rules_from_text("auto"), MaskRules{});
    EXPECT_EQ(mask_rules_from_text("none"), (MaskRules{false, {}, {}}));
    const MaskRules rules =
        mask_rules_from_text("first:10, second:15.5,box:300-350x500-560,third:1,half:2,auto");
    EXPECT_TRUE(rules.automatic);
    ASSERT_EQ(rules.lines.size(), 4u);
    EXPECT_EQ(rules.lines[1], (ScatterLine{ScatterOrder::Second, 15.5}));
    ASSERT_EQ(rules.boxes.size(), 1u);
    EXPECT_EQ(rules.boxes[0], (MaskBox{300.0, 350.0, 500.0, 560.0}));
    for (const char* const text : {"auto", "none", "first:10,box:300-350x500-560",
                                   "auto,second:15.5,box:1-2x3-4,box:5-5x6-6"})
        EXPECT_EQ(mask_rules_text(mask_rules_from_text(text)), text);
}

TEST(MaskRules, AnythingElseIsRefused) {
    for (const char* const text : {"",
                                   ",",
                                   "auto,",
                                   "none,auto",
                                   "secnd:10",
                                   "second",
                                   "second:",
                                   "second:0",
                                   "second:-3",
                                   "second:nan",
                                   "second:1e300",
                                   "second:10nm",
                                   "second:5,second:6",
                                   "box:",
                                   "box:300-350",
                                   "box:350-300x500-560",
                                   "box:300-350x560-500",
                                   "box:300-350x500-560x",
                                   "box:300x500",
                                   "box:-1-2x3-4",
                                   "Second:10",
                                   "second=10"})
        try {
            mask_rules_from_text(text);
            ADD_FAILURE() << "not refused: " << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2) << text;
            EXPECT_NE(std::string(error.what()).find("--mask"), std::string::npos) << text;
        }
}

TEST(FitMask, LinesLeaveTheDiagonalAndBoxesTakeIt) {
    const BispectralData data = noisy_data(true_matrix(two_fluorophores()), 1e-3, true, 1);
    const FitMask line = mask_of(data, mask_rules_from_text("first:20"), {});
    const FitMask box = mask_of(data, mask_rules_from_text("box:400-420x400-420"), {});
    EXPECT_EQ(line.entries(2, 10), 0.0); // 400 nm
    EXPECT_EQ(line.entries(4, 10), 1.0);
    EXPECT_EQ(line.entries(5, 10), 0.0);
    EXPECT_EQ(box.entries.sum(), 9.0);
    EXPECT_EQ(box.measured, 9);
    EXPECT_EQ(box.entries(2, 10), 1.0);
    const BispectralData gaps = with_gaps(data, line);
    EXPECT_TRUE(std::isnan(gaps.blocks[0].value(4, 10)));
    EXPECT_TRUE(std::isnan(gaps.blocks[0].sigma(4, 10)));
    EXPECT_EQ(gaps.measured_count(), data.measured_count() - line.measured);
}

TEST(FitMask, RulesThatMissOrTakeEverythingAreSaid) {
    const BispectralData data = noisy_data(true_matrix(two_fluorophores()), 1e-3, true, 1);
    const FitMask missed = mask_of(data, mask_rules_from_text("box:100-200x500-560"), {});
    EXPECT_FALSE(missed.any());
    EXPECT_TRUE(says(missed.warnings, "box:100-200x500-560: no measured entry lies there"));
    EXPECT_THROW(mask_of(data, mask_rules_from_text("box:0-900x0-900"), {}), Error);
    EXPECT_THROW(mask_of(data, mask_rules_from_text("first:1000"), {}), Error);
}

TEST(FitMask, ScatterNoLongerHidesTheFluorescence) {
    const BispectralData data = read_bispectral_data(inputs / "second-order-scatter.csv");
    // The file's fluorescence: excitation about 360, emission about 480, both of sigma 28 to 29.
    for (const char* const mask : {"auto", "second:10", "box:300-400x600-820"}) {
        const FitResult result = fit(data, mask, 1);
        EXPECT_EQ(result.rank, 1) << mask;
        EXPECT_LT(result.relative_rmse, 0.005) << mask; // four decimals of 0.05
        EXPECT_NEAR(result.matrix.values(3, 3), 0.05, 2e-4) << mask;
        EXPECT_LT(result.matrix.values.bottomRows(12).maxCoeff(), 2e-4) << mask;
    }
    const FitResult automatic = fit(data, "auto", 1), kept = fit(data, "none", 1);
    ASSERT_EQ(automatic.mask.found.size(), 1u);
    EXPECT_EQ(automatic.mask.found[0].line, (ScatterLine{ScatterOrder::Second, 10.0}));
    EXPECT_EQ(automatic.mask.measured, 6);
    EXPECT_TRUE(says(automatic.notes, "second-order scatter at emission = 2 x excitation"));
    EXPECT_GT(kept.relative_rmse, 0.5);
    EXPECT_EQ(fit_summary(automatic)["mask"]["rules"], "auto,second:10");
    EXPECT_EQ(fit_summary(automatic)["mask"]["found"][0]["order"], "second");
}

TEST(FitMask, NoiseBandsAndMatrixAreThoseOfDataWithGaps) {
    // The scatter is as high as the fluorescence, once narrow and once over three bands.
    for (const double fwhm : {2.0, 10.0}) {
        const ScatteredData data(2.0, 1.0, fwhm);
        const FitResult masked = fit(data.scattered, "auto", 2);
        ASSERT_EQ(masked.mask.found.size(), 1u);
        const FitResult gaps =
            fit(data.clean, mask_rules_text({false, masked.mask.rules.lines, {}}), 2);
        EXPECT_TRUE(masked.matrix.values == gaps.matrix.values) << fwhm;
        EXPECT_EQ(masked.noise, gaps.noise);
        EXPECT_NEAR(masked.noise / data.noise, 1.0, 0.2);
        EXPECT_NEAR(masked.reduced_chi_squared, 1.0, 0.15);
        // Fits of the whole matrix reach half of the noise.
        EXPECT_LT(stokes_rmse(masked.matrix, data.truth), 0.7 * data.noise);
        EXPECT_GT(coverage(masked, data.truth), 0.9);
        EXPECT_GT(stokes_rmse(fit(data.scattered, "none", 2).matrix, data.truth), data.noise);
    }
}

TEST(FitMask, FirstOrderKeepsTheReflectance) {
    // Two bands to each side of the diagonal hold reflected light; the reflectance stays.
    ScatteredData data(1.0, 20.0, 25.0, true);
    BispectralBlock& block = data.scattered.blocks[0];
    for (int o = 0; o < 41; ++o)
        block.value(o, o + 8) = data.clean.blocks[0].value(o, o + 8);
    const FitResult result = fit(data.scattered, "auto", 2);
    ASSERT_EQ(result.mask.found.size(), 1u);
    EXPECT_EQ(result.mask.found[0].line, (ScatterLine{ScatterOrder::First, 20.0}));
    for (int o = 0; o < 41; ++o)
        EXPECT_EQ(result.matrix.values(o, o + 8), std::clamp(block.value(o, o + 8), 0.0, 1.0));
    EXPECT_FALSE(says(result.notes, "interpolated"));
    // Beside the diagonal the model goes on from farther out.
    EXPECT_LT(stokes_rmse(result.matrix, data.truth), 2.0 * data.noise);
}

TEST(FitMask, WhereNothingStandsOutNothingChanges) {
    const BispectralData data = ScatteredData(2.0, 0.0, 2.0).clean;
    const FitResult automatic = fit(data, "auto", 2), none = fit(data, "none", 2);
    EXPECT_TRUE(automatic.mask.found.empty());
    EXPECT_FALSE(automatic.mask.any());
    EXPECT_TRUE(automatic.matrix.values == none.matrix.values);
    EXPECT_TRUE(automatic.notes == none.notes);
}

TEST(FitMask, LinesThatStandOutOfOneDirectionAreMaskedInAll) {
    ScatteredData made(2.0, 1.0, 2.0, true);
    BispectralData data = made.scattered;
    data.blocks.push_back(made.clean.blocks[0]);
    data.blocks[0].geometry = {45.0, 0.0, 0.0};
    data.blocks[1].geometry = {45.0, 60.0, 0.0};
    const FitMask mask = mask_of(data, {}, {10.0, false});
    ASSERT_EQ(mask.found.size(), 1u);
    const BispectralData gaps = with_gaps(data, mask);
    EXPECT_EQ(gaps.measured_count(), data.measured_count() - 2 * mask.measured);
    EXPECT_TRUE(std::isnan(gaps.blocks[1].value(22, 0))); // 600 nm at 300 nm
    const FitResult result = fit(data, "auto", 2);
    EXPECT_EQ(result.mask.measured, 10);
    EXPECT_LT(stokes_rmse(result.matrix, made.truth), 0.7 * made.noise);
}

TEST(FitMask, LongFormIsMaskedLikeWideForm) {
    const BispectralData wide = read_bispectral_data(inputs / "second-order-scatter.csv");
    std::string text = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                       "# kind: measured\nexcitation_nm,emission_nm,value\n";
    for (int i = 0; i < wide.excitation.count; ++i)
        for (int o = 0; o < wide.emission.count; ++o)
            text += std::to_string(wide.excitation.centre_nm(i)) + "," +
                    std::to_string(wide.emission.centre_nm(o)) + "," +
                    std::to_string(wide.blocks[0].value(o, i)) + "\n";
    const TemporaryFolder folder;
    put_bytes(folder / "long.csv", text);
    const FitResult from_long = fit(read_bispectral_data(folder / "long.csv"), "auto", 1);
    EXPECT_EQ(from_long.mask.measured, 6);
    EXPECT_TRUE(from_long.matrix.values == fit(wide, "auto", 1).matrix.values);
}
