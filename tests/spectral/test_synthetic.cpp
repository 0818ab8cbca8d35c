#include "reradiant/colour.h"
#include "reradiant/paths.h"
#include "reradiant/spectral_files.h"
#include "tests/spectral/synthetic_recipes.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace reradiant;

namespace {

ReradiationMatrix from_file(const SyntheticRecipe& recipe) {
    return read_reradiation(spectra_directory() / "reradiation" / recipe.file);
}

} // namespace

TEST(Synthetic, FilesAreWhatTheirRecipesGive) {
    for (const SyntheticRecipe& recipe : synthetic_recipes()) {
        const ReradiationMatrix file = from_file(recipe), made = synthetic_matrix(recipe);
        EXPECT_EQ(file.emission, made.emission);
        EXPECT_EQ(file.excitation, made.excitation);
        EXPECT_EQ(file.kind, MatrixKind::Model);
        // The files hold nine digits.
        EXPECT_LT((file.values - made.values).cwiseAbs().maxCoeff(), 1e-9) << recipe.file;
    }
}

TEST(Synthetic, NoColumnGainsEnergyOrPhotons) {
    for (const SyntheticRecipe& recipe : synthetic_recipes()) {
        ReradiationMatrix matrix = from_file(recipe);
        const ColumnBalance balance = column_balance(matrix);
        EXPECT_LT(*std::max_element(balance.radiant.begin(), balance.radiant.end()), 1.0);
        EXPECT_LT(*std::max_element(balance.photons.begin(), balance.photons.end()), 1.0);
        std::vector<std::string> warnings;
        EXPECT_TRUE(repair_for_rendering(matrix, warnings).text().empty());
        EXPECT_TRUE(warnings.empty());
    }
}

TEST(Synthetic, OrangeGlowsUnderDaylightUvAndViolet) {
    const ReradiationMatrix orange = from_file(synthetic_recipes()[0]);
    const Spectrum d65 = illuminant("D65");
    const int at = orange.emission.band_of(600);
    double beta = 0.0;
    for (int i = 0; i < orange.excitation.count; ++i)
        beta += orange.values(at, i) * d65(orange.excitation.centre_nm(i)) / d65(600);
    EXPECT_GT(beta, 1.5);
    for (const double nm : {365.0, 405.0})
        EXPECT_GT(orange.values(at, orange.excitation.band_of(nm)), 0.02);
}

TEST(Synthetic, EachIsOneTerm) {
    for (const SyntheticRecipe& recipe : synthetic_recipes()) {
        const MaskedFactors factors = factorise_lower(from_file(recipe).values, 4, 1e-6);
        EXPECT_EQ(factors.rank(), 1) << recipe.file;
    }
}
