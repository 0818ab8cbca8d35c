#include "host/fit/result/fit_report.h"
#include "reradiant/fit.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene.h"
#include "reradiant/scene_file.h"
#include "tests/film/film_fixtures.h"
#include "tests/fit/fit_cases.h"

#include <gtest/gtest.h>

using namespace reradiant;

namespace {

FitResult fitted(std::optional<int> rank) {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    FitSettings settings;
    settings.rank = rank;
    return fit_reradiation(noisy_data(truth, 0.002 * stokes_peak(truth), true, 5), settings);
}

} // namespace

TEST(ModelFile, ScenesTakeItAsReradiation) {
    const TemporaryFolder folder;
    const FitResult fit = fitted(2);
    const double difference = write_model_file(folder / "model.toml", fit, "unused.csv");
    // Tables are linear between bands and the fit is of band centres: some curvature remains.
    EXPECT_LE(difference, 0.05);
    const Material material = load_material(folder / "model.toml");
    ASSERT_EQ(material.substrate.fluorophores.size(), 2u);
    const ReradiationMatrix scene =
        matrix_from_fluorophores(material.substrate.fluorophores, material.substrate.reflectance,
                                 fit.matrix.emission, fit.matrix.excitation);
    EXPECT_LE(stokes_rmse(scene, fit.matrix), 0.01 * stokes_peak(fit.matrix));
    for (int i = 8; i < fit.matrix.excitation.count; ++i)
        EXPECT_NEAR(scene.values(i - 8, i), fit.matrix.values(i - 8, i), 0.02) << i;
}

TEST(ModelFile, NoFluorescenceIsAReflectance) {
    const TemporaryFolder folder;
    const FitResult fit = fit_reradiation(noisy_data(true_matrix({}), 0.0, false, 5), {});
    write_model_file(folder / "model.toml", fit, "unused.csv");
    const Material material = load_material(folder / "model.toml");
    EXPECT_FALSE(material.substrate.is_fluorescent());
    EXPECT_NEAR(material.substrate.reflectance(500.0), 0.1, 1e-6);
}

TEST(FitReport, HoldsWhatItPromises) {
    const TemporaryFolder folder;
    const FitResult fit = fitted(1);
    write_fit_report(folder / "report.html",
                     noisy_data(true_matrix(two_fluorophores()), 0.001, true, 5), fit);
    const std::string page = file_bytes(folder / "report.html");
    for (const char* words : {"Quantum yield", "residuals", "95 % bands", "Convergence",
                              "why it stopped", "peak memory", "bytes of the compact form"})
        EXPECT_NE(page.find(words), std::string::npos) << words;
    EXPECT_EQ(page.find("<script"), std::string::npos);
}
