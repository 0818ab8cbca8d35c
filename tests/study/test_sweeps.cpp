#include "host/study/study/sweep_apply.h"
#include "reradiant/colour.h"
#include "tests/study/study_fixtures.h"

#include <cmath>
#include <numbers>

namespace reradiant {
namespace {

class Sweeps : public test::StudyTest {
protected:
    /// The scene with the n-th value of the only sweep.
    Scene with(const std::string& sweep, std::size_t value) const {
        const Study study = load(head + "[[sweep]]\n" + sweep);
        return scene_with(study, {{&study.sweeps[0], &study.sweeps[0].values[value]}});
    }
};

TEST_F(Sweeps, LayerParametersReachTheLayer) {
    const auto layer = [&](const std::string& sweep) {
        return with(sweep, 1).materials[0].stack.layers[0];
    };
    EXPECT_EQ(layer("parameter = \"thickness\"\nvalues = [1, 3]").thickness, 3.0);
    EXPECT_EQ(layer("parameter = \"ior\"\nvalues = [1.4, 1.6]").ior(550), 1.6);
    EXPECT_EQ(layer("parameter = \"absorption\"\nvalues = [0, 0.7]").absorption(550), 0.7);
    EXPECT_EQ(layer("parameter = \"roughness\"\nvalues = [1, 10]").alpha,
              alpha_from_roughness_deg(Distribution::Ggx, 10.0))
        << "instead of the alpha that the material gives";
    EXPECT_EQ(layer("key = \"material.sample.layer.0.alpha\"\nvalues = [0.1, 0.4]").alpha, 0.4);
}

TEST_F(Sweeps, AngleTiltsTheSampleAndKeepsTheLampInItsMirrorDirection) {
    const Scene scene = with("parameter = \"angle\"\nvalues = [5, 60]", 1);
    const auto& sample = std::get<RectangleShape>(scene.shapes[0].geometry);
    const auto& lamp = std::get<RectangleLight>(scene.lights[0]);
    // Normal of the sample is cross(u, v); u lies along x.
    const double normal_y = -sample.edge_u[0] * sample.edge_v[2];
    const double normal_z = sample.edge_u[0] * sample.edge_v[1];
    EXPECT_NEAR(std::atan2(normal_y, normal_z) * 180.0 / std::numbers::pi, 60.0, 1e-9);
    EXPECT_NEAR(std::atan2(lamp.centre[1], lamp.centre[2]) * 180.0 / std::numbers::pi, 120.0, 1e-9);
    // The lamp looks back at the sample: cross(u, v) is opposite to its place.
    const double facing_y = -lamp.edge_u[0] * lamp.edge_v[2];
    const double facing_z = lamp.edge_u[0] * lamp.edge_v[1];
    EXPECT_LT(facing_y * lamp.centre[1] + facing_z * lamp.centre[2], 0.0);
    EXPECT_NEAR(facing_y * lamp.centre[2] - facing_z * lamp.centre[1], 0.0, 1e-9);
}

TEST_F(Sweeps, IlluminantByNameKeepsTheLuminanceAndBySpectrumIsTakenAsItIs) {
    const std::string sweep =
        "parameter = \"illuminant\"\nvalues = [\"A\", { line_nm = 405, width_nm = 2, scale = 8 }]";
    const Spectrum named = light_spectrum(with(sweep, 0).lights[0]);
    EXPECT_NEAR(xyz_of(named)[1], 120.0, 1e-6) << "the built-in lamp's luminance";
    EXPECT_GT(named(700), 2.0 * named(450)) << "illuminant A is red";
    const Spectrum line = light_spectrum(with(sweep, 1).lights[0]);
    EXPECT_NEAR(line(405), 4.0, 1e-12);
    EXPECT_EQ(line(550), 0.0);
    EXPECT_THROW(with("parameter = \"illuminant\"\nvalues = [\"D65\", \"D99\"]", 1), Error);
}

TEST_F(Sweeps, ConcentrationFollowsBeerAndLambert) {
    const Scene once = with("parameter = \"concentration\"\nvalues = [1, 2]", 0);
    const Scene twice = with("parameter = \"concentration\"\nvalues = [1, 2]", 1);
    const auto dye = [](const Scene& scene) -> const Fluorophore& {
        return scene.materials[0].substrate.fluorophores[0];
    };
    // At the peak, a whole nanometre, half is absorbed once and three quarters twice.
    EXPECT_NEAR(dye(once).excitation(450), 0.5, 1e-12);
    EXPECT_NEAR(dye(twice).excitation(450), 0.75, 1e-12);
    EXPECT_NEAR(twice.materials[0].substrate.reflectance(450), 0.3 * 0.5, 1e-12)
        << "half as much passes to be reflected";
    EXPECT_NEAR(twice.materials[0].substrate.reflectance(700), 0.3, 1e-9) << "no dye there";
    EXPECT_EQ(dye(twice).quantum_yield, 0.8);
}

TEST_F(Sweeps, ConcentrationsAndThicknessOfDyedLayersAreSwept) {
    put("dyed.toml", "[material]\n[[material.layer]]\nior = 1.5\nthickness = 2\n"
                     "fluorophores = [ { absorption = 1, concentration = 0.5, emission = { "
                     "gaussian_nm = 600, sigma_nm = 20 } }, { absorption = 2, emission = { "
                     "gaussian_nm = 650, sigma_nm = 20 } } ]\n"
                     "[material.substrate]\ntype = \"lambert\"\n");
    const auto layer = [&](const std::string& sweep, std::size_t value = 1) {
        const Study study = load("[study]\nmaterial = \"dyed.toml\"\n[[sweep]]\n" + sweep);
        const Sweep& only = study.sweeps[0];
        return scene_with(study, {{&only, &only.values[value]}}).materials[0].stack.layers[0];
    };
    const Layer of_all = layer("parameter = \"concentration\"\nlayer = 0\nvalues = [1, 4]");
    EXPECT_EQ(of_all.dyes[0].concentration, 2.0) << "times what the file has";
    EXPECT_EQ(of_all.dyes[1].concentration, 4.0);
    const std::string second =
        "parameter = \"concentration\"\nlayer = 0\nfluorophore = 1\nvalues = [0, 3]";
    EXPECT_EQ(layer(second).dyes[0].concentration, 0.5);
    EXPECT_EQ(layer(second).dyes[1].concentration, 3.0);
    EXPECT_EQ(layer(second, 0).dyes[1].concentration, 0.0) << "no dye at all";
    EXPECT_EQ(layer("parameter = \"concentration\"\nvalues = [1, 4]").dyes[1].concentration, 4.0)
        << "the only layer with dyes over a substrate without is meant";
    EXPECT_EQ(layer("key = \"material.sample.layer.0.fluorophores.0.concentration\"\n"
                    "values = [1, 4]")
                  .dyes[0]
                  .concentration,
              4.0)
        << "by its key it is the number itself";
    EXPECT_EQ(layer("parameter = \"thickness\"\nvalues = [1, 3]").thickness, 3.0);
}

// Spectra are then warned about on these bands alone.
TEST_F(Sweeps, WhatIsOnlyMeasuredHasTheBandsOfItsMatrices) {
    put("p.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                 "nm,400,500\n400,0.3,0\n500,0.2,0.5\n");
    put("shares.toml", "[material]\n[[material.layer]]\nior = 1.5\nfluorophores = [ { absorption = "
                       "1, shares = { file = \"p.csv\" } } ]\n"
                       "[material.substrate]\ntype = \"none\"\n");
    const std::string shares = "[study]\nmaterial = \"shares.toml\"\n";
    const std::string sweep = "[[sweep]]\nparameter = \"thickness\"\nvalues = [1, 2]\n";
    const Study measured = load(shares + "[measure]\n" + sweep);
    const Study rendered = load(shares + "[measure]\n[render]\n" + sweep);
    EXPECT_EQ(scene_with(measured, {}).film.bands, (WavelengthGrid{400.0, 100.0, 2}));
    EXPECT_FALSE(scene_with(rendered, {}).film.bands.has_value());
}

// Two equal coats are computed as one, and each can be swept by itself.
TEST_F(Sweeps, LayersAreCountedAsTheyAreWritten) {
    const std::string coat = "[[material.layer]]\nior = 1.5\nfluorophores = [ { absorption = 1, "
                             "emission = { gaussian_nm = 600, sigma_nm = 20 } } ]\n";
    put("coats.toml", "[material]\n" + coat + coat + "[material.substrate]\ntype = \"none\"\n");
    const std::string coats = "[study]\nmaterial = \"coats.toml\"\n[[sweep]]\n";
    const auto stack = [&](const std::string& sweep) {
        const Study study = load(coats + sweep);
        return scene_with(study, {{&study.sweeps[0], &study.sweeps[0].values[1]}})
            .materials[0]
            .stack;
    };
    const std::string second = "parameter = \"concentration\"\nlayer = 1\nvalues = [1, 3]";
    ASSERT_EQ(stack(second).layers.size(), 1u);
    EXPECT_EQ(stack(second).layers[0].thickness, 4.0) << "one unit, and one of three times the dye";
    EXPECT_EQ(stack("parameter = \"thickness\"\nlayer = 1\nvalues = [1, 2]").layers[0].thickness,
              3.0);
    EXPECT_NE(refusal(coats + "parameter = \"concentration\"\nvalues = [1, 3]\n")
                  .find("study.toml:4:1: layers 0, 1 hold fluorophores"),
              std::string::npos);
}

TEST_F(Sweeps, MatrixIsLookedForBesideTheStudyAndReplacesReflectance) {
    put("grey.toml", "[material]\n[material.substrate]\ntype = \"lambert\"\nreflectance = 0.5\n");
    put("matrix.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                      "nm,400,500\n400,0.3,0\n500,0.2,0.5\n");
    const Study study = load("[study]\nmaterial = \"grey.toml\"\n[[sweep]]\n"
                             "parameter = \"matrix\"\nvalues = [\"matrix.csv\"]\n");
    const Scene scene = scene_with(study, {{&study.sweeps[0], &study.sweeps[0].values[0]}});
    EXPECT_TRUE(scene.materials[0].substrate.is_fluorescent());
    EXPECT_EQ(study.sweeps[0].values[0].label, "matrix.csv");
}

TEST_F(Sweeps, PresetsAreWrittenOutSoThatTheirPartsCanBeSwept) {
    const Study study = load("[study]\npreset = \"fluorescent-orange-rough\"\n[[sweep]]\n"
                             "parameter = \"thickness\"\nvalues = [1, 2]\n");
    const Scene scene = scene_with(study, {{&study.sweeps[0], &study.sweeps[0].values[1]}});
    EXPECT_EQ(scene.materials[0].stack.layers[0].thickness, 2.0);
}

TEST_F(Sweeps, HashTellsCellsApart) {
    const std::string sweep = "parameter = \"thickness\"\nvalues = [1, 2]";
    EXPECT_NE(with(sweep, 0).hash, with(sweep, 1).hash);
    EXPECT_EQ(with(sweep, 0).hash, with(sweep, 0).hash);
}

} // namespace
} // namespace reradiant
