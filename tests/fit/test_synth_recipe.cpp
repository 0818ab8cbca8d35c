#include "reradiant/error.h"
#include "reradiant/reradiation.h"
#include "reradiant/synth.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>

using namespace reradiant;

namespace {

constexpr const char* good = "reflectance = 0.1\n"
                             "[[fluorophore]]\n"
                             "absorptance = 0.8\n"
                             "quantum_yield = 0.9\n"
                             "excitation = { peak_nm = 480, width_nm = 60, skew = 0.7 }\n"
                             "emission = { peak_nm = 560, width_nm = 50 }\n";

class SynthRecipes : public test::ScratchFolder {
protected:
    SynthRecipe read(const std::string& text) const {
        return read_synth_recipe(write("recipe.toml", text));
    }
    /// The good recipe with one piece replaced must be refused at the place.
    void expect_refused(const std::string& from, const std::string& to, const std::string& place,
                        const std::string& says) const {
        std::string text = good;
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
        try {
            read(text);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2);
            const std::string message = error.what();
            EXPECT_NE(message.find(path("recipe.toml").string() + place), std::string::npos)
                << message;
            EXPECT_NE(message.find(says), std::string::npos) << message;
        }
    }
    static double peak_nm(const Spectrum& spectrum) {
        double best = 200.0;
        for (double nm = 200.0; nm <= 1000.0; nm += 0.5)
            if (spectrum(nm) > spectrum(best))
                best = nm;
        return best;
    }
};

} // namespace

TEST_F(SynthRecipes, DefaultsAreThoseOfAnInstrument) {
    const SynthRecipe recipe = read(good);
    EXPECT_EQ(recipe.emission, (WavelengthGrid{380, 10, 41}));
    EXPECT_EQ(recipe.excitation, (WavelengthGrid{300, 10, 49}));
    ASSERT_EQ(recipe.fluorophores.size(), 1u);
    EXPECT_EQ(recipe.fluorophores[0].quantum_yield, 0.9);
    EXPECT_NEAR(recipe.fluorophores[0].excitation(480), 0.8, 1e-12);
    EXPECT_EQ(peak_nm(recipe.fluorophores[0].emission), 560.0);
    EXPECT_TRUE(recipe.geometries.empty());
    EXPECT_EQ(recipe.noise.read_of_peak, 0.0);
}

TEST_F(SynthRecipes, EmissionMayBeShiftedOrMirrored) {
    const std::string start = std::string(good).substr(0, std::string(good).find("emission"));
    const auto emission = [&](const std::string& lines) {
        return read(start + lines).fluorophores[0].emission;
    };
    EXPECT_EQ(peak_nm(emission("emission = { width_nm = 40 }\nstokes_shift_nm = 75\n")), 555.0);
    const double shifted = 1e7 / (1e7 / 480.0 - 2500.0);
    EXPECT_NEAR(peak_nm(emission("emission = { width_nm = 40 }\nstokes_shift_per_cm = 2500\n")),
                shifted, 0.5);
    const Spectrum mirror = emission("mirror = true\nzero_zero_nm = 515\n");
    EXPECT_NEAR(peak_nm(mirror), 1e7 / (2e7 / 515.0 - 1e7 / 480.0), 0.5);
    const Spectrum excitation = read(good).fluorophores[0].excitation;
    for (const double away : {-1000.0, 500.0, 2000.0}) // linear between steps of 0.5 nm
        EXPECT_NEAR(mirror(1e7 / (1e7 / 515.0 - away)),
                    excitation(1e7 / (1e7 / 515.0 + away)) / 0.8, 2e-3);
    EXPECT_NEAR(peak_nm(emission("mirror = true\nstokes_shift_nm = 80\n")), 560.0, 0.5);
}

TEST_F(SynthRecipes, TheExamplesAreGood) {
    const std::filesystem::path examples =
        std::filesystem::path(RERADIANT_SOURCE_DIR) / "tools" / "examples";
    const SynthRecipe orange = read_synth_recipe(examples / "synth-orange.toml");
    EXPECT_GT(orange.instrument.spill, 0.0);
    const SynthRecipe varnished = read_synth_recipe(examples / "synth-varnished.toml");
    EXPECT_EQ(varnished.fluorophores.size(), 2u);
    EXPECT_EQ(varnished.geometries.size(), 6u);
    for (const SynthRecipe& recipe : {orange, varnished}) {
        const std::vector<double> photons = column_balance(synth_truth(recipe)).photons;
        EXPECT_LE(*std::max_element(photons.begin(), photons.end()), 1.0);
    }
}

TEST_F(SynthRecipes, BadRecipesAreRefusedAtTheirPlace) {
    expect_refused("reflectance", "reflectence", ":1:1", "reflectance");
    expect_refused("0.1\n", "0.3\n", ":1:1", "together 1.1 at");
    expect_refused("absorptance = 0.8\n", "", ":2:1", "absorptance");
    expect_refused("absorptance = 0.8", "absorptance = 1.2", ":3:1", "absorptance");
    expect_refused("quantum_yield = 0.9", "quantum_yield = 90", ":4:1", "quantum_yield");
    expect_refused("peak_nm = 480", "peak_nm = 48", ":5:16", "peak_nm");
    expect_refused("width_nm = 60", "width_nm = 60, width_per_cm = 2500", ":5:46", "both");
    expect_refused("width_nm = 60, ", "", ":5:14", "width_nm");
    expect_refused("skew = 0.7", "skew = 0", ":5:46", "skew");
    expect_refused("emission = { peak_nm = 560, width_nm = 50 }", "", ":2:1", "emission");
    expect_refused("[[fluorophore]]", "[noise]\nread_of_peak = -1\n[[fluorophore]]", ":3:1",
                   "read_of_peak");
    expect_refused("[[fluorophore]]", "[[material.layer]]\nior = 1.5\n[[fluorophore]]", ":2:3",
                   "none is given");
    expect_refused("[[fluorophore]]",
                   "[geometry]\ntheta_i_deg = [0]\ntheta_o_deg = [95]\nphi_deg = [0]\n"
                   "[[fluorophore]]",
                   ":4:16", "theta_o_deg");
    expect_refused("[[fluorophore]]",
                   "[geometry]\ntheta_i_deg = [0]\ntheta_o_deg = [5, 5]\nphi_deg = [0]\n"
                   "[[fluorophore]]",
                   ":4:1", "twice");
    expect_refused("reflectance = 0.1",
                   "reflectance = 0.1\nemission_nm = { from = 380, to = 785, step = 10 }", ":2:1",
                   "whole number of steps");
}

TEST_F(SynthRecipes, ContradictoryEmissionsAreRefused) {
    const std::string emission = "emission = { peak_nm = 560, width_nm = 50 }\n";
    expect_refused(emission, emission + "mirror = true\n", ":6:1", "both mirror and emission");
    expect_refused(emission, "mirror = true\n", ":6:1", "0-0 line");
    expect_refused(emission, "mirror = 1\n", ":6:1", "true or false");
    expect_refused(emission, "mirror = true\nzero_zero_nm = 470\n", ":7:1", "0-0 line");
    expect_refused(emission, "mirror = true\nzero_zero_nm = 500\nstokes_shift_nm = 20\n", ":8:1",
                   "both");
    expect_refused(emission, emission + "stokes_shift_nm = 20\n", ":6:14", "both");
    expect_refused(emission, emission + "zero_zero_nm = 500\n", ":7:1", "mirror");
    expect_refused(emission, "emission = { width_nm = 50 }\nstokes_shift_nm = 900\n", ":7:1",
                   "1380");
}

TEST_F(SynthRecipes, Case36TruncatedRecipesAreRefusedOrRead) {
    const std::string whole = good;
    for (std::size_t length = 0; length < whole.size(); ++length) {
        try {
            read(whole.substr(0, length));
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2) << length;
        }
    }
}

TEST_F(SynthRecipes, OneToFourFluorophores) {
    EXPECT_THROW(read("reflectance = 0.1\n"), Error);
    std::string text = "reflectance = 0.0\n";
    for (int k = 0; k < 5; ++k)
        text += "[[fluorophore]]\nabsorptance = 0.1\nquantum_yield = 0.5\n"
                "excitation = { peak_nm = 400, width_nm = 40 }\n"
                "emission = { peak_nm = 500, width_nm = 40 }\n";
    EXPECT_THROW(read(text), Error);
}

TEST_F(SynthRecipes, LayersMayHoldDyesInsteadOfTheSubstrate) {
    const std::string dyed = "reflectance = 0.8\n[[material.layer]]\nior = 1.5\n"
                             "[[material.layer.fluorophores]]\nabsorption = 0.5\n"
                             "emission = { gaussian_nm = 550, sigma_nm = 20 }\n"
                             "quantum_yield = 0.9\n";
    const std::string geometry =
        "[geometry]\ntheta_i_deg = [45]\ntheta_o_deg = [0]\nphi_deg = [0]\n";
    const SynthRecipe recipe = read(dyed + geometry);
    EXPECT_TRUE(recipe.fluorophores.empty());
    ASSERT_TRUE(recipe.stack.is_dyed());
    EXPECT_EQ(recipe.stack.layers[0].dyes[0].quantum_yield, 0.9);
    EXPECT_THROW(read(dyed + "concentration = 0\n" + geometry), Error) << "nothing fluoresces";
}

TEST_F(SynthRecipes, SheetsAndSubstratesOfMaterialsAreRefused) {
    expect_refused("[[fluorophore]]",
                   "[[material.layer]]\nior = 1.5\n[material.back]\nalpha = 0.1\n[[fluorophore]]",
                   ":4:11", "a sheet has none");
    expect_refused("[[fluorophore]]",
                   "[[material.layer]]\nior = 1.5\n[material.substrate]\ntype = \"none\"\n"
                   "[[fluorophore]]",
                   ":4:11", "are the substrate");
}
