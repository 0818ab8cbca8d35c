#include "host/layers/stack/slab_emission.h"
#include "host/scene/model/fluorescence_ranges.h"
#include "host/scene/model/matrix_grids.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene_file.h"
#include "reradiant/stack_elements.h"
#include "tests/scene/scratch.h"

#include <limits>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

/// Materials of one layer with one dye, whose keys stand from line 5 on.
class SlabDyes : public Scratch {
protected:
    static std::string text(const std::string& keys, const std::string& head = "[material]\n") {
        return head + "[[material.layer]]\nior = 1.5\n[[material.layer.fluorophores]]\n" + keys +
               "\n[material.substrate]\ntype = \"lambert\"\nreflectance = 0.5\n";
    }
    Material material(const std::string& keys) const {
        return load_material(write("m.toml", text(keys)));
    }
    SlabDye dye(const std::string& keys) const {
        return material(keys).stack.layers.at(0).dyes.at(0);
    }
    void expect_error(const std::string& content, int line, int column,
                      const std::string& message) const {
        const auto file = write("m.toml", content);
        const Caught error = error_of([&] { load_material(file); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_EQ(error.file, file.string());
        EXPECT_EQ(error.line, line) << error.text;
        EXPECT_EQ(error.column, column) << error.text;
        EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
    }
    std::vector<std::string> warnings(const std::string& keys) const {
        return warnings_of([&] { material(keys); });
    }
    /// p.csv, a matrix of bands at 400, 500 and 600 nm, rows = emission.
    void put_shares(const std::string& rows, const std::string& head = "") const {
        write("p.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n" +
                           head + "nm,400,500,600\n" + rows);
    }
};

const std::string ABSORPTION = "absorption = { gaussian_nm = 450, sigma_nm = 20, scale = 3 }\n";
const std::string EMISSION = "emission = { gaussian_nm = 550, sigma_nm = 20 }\n";
const std::string BAND = ABSORPTION + EMISSION;
const std::string SHARES = "absorption = 0.5\nshares = { file = \"p.csv\" }";
const std::string GOOD_ROWS = "400,0.1,0,0\n500,0.4,0.2,0\n600,0.2,0.6,0.05\n";

} // namespace

TEST_F(SlabDyes, EveryKeyIsRead) {
    const SlabDye read = dye(BAND + "concentration = 0.25\nquantum_yield = 0.8");
    EXPECT_EQ(read.absorption(450.0), 3.0);
    EXPECT_EQ(read.concentration, 0.25);
    EXPECT_EQ(read.emission(550.0), 1.0);
    EXPECT_EQ(read.quantum_yield, 0.8);
    EXPECT_FALSE(read.shares);
    EXPECT_TRUE(read.absorbs());
}

TEST_F(SlabDyes, ConcentrationAndYieldAreOneWithoutTheirKeys) {
    const SlabDye read = dye(BAND);
    EXPECT_EQ(read.concentration, 1.0);
    EXPECT_EQ(read.quantum_yield, 1.0);
}

TEST_F(SlabDyes, AMaterialWithADyeFluoresces) {
    const Material read = material(BAND);
    EXPECT_TRUE(read.is_fluorescent());
    EXPECT_FALSE(read.substrate.is_fluorescent());
    const FluorescenceRanges ranges = fluorescence_ranges(read);
    // Gaussians count within six standard deviations.
    EXPECT_NEAR(ranges.excitation[0], 330.0, 1.0);
    EXPECT_NEAR(ranges.excitation[1], 570.0, 1.0);
    EXPECT_NEAR(ranges.emission[0], 430.0, 1.0);
    EXPECT_NEAR(ranges.emission[1], 670.0, 1.0);
}

TEST_F(SlabDyes, ALayerMayHoldSeveral) {
    const Material read = load_material(
        write("m.toml", text(BAND + "[[material.layer.fluorophores]]\nabsorption = 0.1\n" +
                             "emission = { gaussian_nm = 650, sigma_nm = 10 }\n")));
    ASSERT_EQ(read.stack.layers[0].dyes.size(), 2u);
    EXPECT_EQ(read.stack.layers[0].dyes[1].absorption(300.0), 0.1);
    EXPECT_NEAR(fluorescence_ranges(read).emission[1], 710.0, 1.0);
}

TEST_F(SlabDyes, SharesAreAMatrix) {
    put_shares(GOOD_ROWS);
    const Material read = material(SHARES);
    const SlabDye& with_shares = read.stack.layers[0].dyes[0];
    ASSERT_TRUE(with_shares.shares);
    EXPECT_EQ(with_shares.shares->values(1, 0), 0.4);
    EXPECT_EQ(dye_shares(with_shares, with_shares.shares->emission), with_shares.shares->values);
    EXPECT_EQ(fluorescence_ranges(with_shares).excitation[0], 350.0);
    EXPECT_EQ(common_grid(matrices_of(read)), grid_from_range(400.0, 600.0, 100.0));
}

TEST_F(SlabDyes, SharesMayBeAntiStokesWhereTheFileAllowsIt) {
    const std::string rows = "400,0.1,0.1,0\n500,0.4,0.2,0\n600,0.2,0.5,0\n";
    put_shares(rows, "# anti-stokes: allowed\n");
    EXPECT_EQ(dye(SHARES).shares->values(0, 1), 0.1);
    put_shares(rows);
    const auto file = write("m.toml", text(SHARES));
    const Caught error = error_of([&] { load_material(file); });
    EXPECT_EQ(error.file, (folder / "p.csv").string());
    EXPECT_NE(error.text.find("anti-Stokes"), std::string::npos) << error.text;
}

TEST_F(SlabDyes, WithoutConcentrationNothingFluoresces) {
    put_shares(GOOD_ROWS);
    for (const std::string& keys : {BAND + "concentration = 0", SHARES + "\nconcentration = 0"}) {
        const Material read = material(keys);
        EXPECT_FALSE(read.is_fluorescent());
        EXPECT_TRUE(matrices_of(read).empty());
        EXPECT_EQ(std::get<SlabValues>(stack_at(read.stack, 450.0)[1]).tau, 0.0);
    }
}

// A material is measured on the bands of its shares, and nothing else of its spectra is used.
TEST_F(SlabDyes, SpectraAreWarnedAboutOnTheBandsThatAreUsed) {
    put_shares(GOOD_ROWS);
    const auto file =
        write("m.toml", text("absorption = { nm = [400, 600], value = [1, 2] }\nshares = { file = "
                             "\"p.csv\" }"));
    EXPECT_TRUE(warnings_of([&] { load_material(file); }).empty());
    const auto warnings =
        warnings_of([&] { load_material(file, grid_from_range(400.0, 700.0, 100.0)); });
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("data from 400 to 600 nm but is used from 400 to 700 nm"),
              std::string::npos)
        << warnings[0];
}

TEST_F(SlabDyes, ConcentrationsFollowTextures) {
    const std::string scene =
        replaced(SMALL_SCENE, "reflectance = 0.5",
                 "reflectance = 0.5\n[[material.layer]]\nior = 1.5\n"
                 "[[material.layer.fluorophores]]\n" +
                     BAND + "concentration = { texture = \"stripes\", low = 0, high = 2 }\n" +
                     "[[texture]]\nname = \"stripes\"\ntype = \"checker\"\n");
    const Scene read = load_scene(write("scene.toml", scene));
    ASSERT_EQ(read.surfaces[0].textures.size(), 1u);
    const auto first = static_cast<std::size_t>(read.surfaces[0].first_material);
    const auto dye_of = [&](std::size_t variant) {
        return read.materials.at(first + variant).stack.layers[0].dyes.at(0);
    };
    EXPECT_EQ(dye_of(0).concentration, 0.0);
    EXPECT_EQ(dye_of(1).concentration, 2.0);
    EXPECT_FALSE(read.materials[first].is_fluorescent());
    EXPECT_TRUE(read.materials[first + 1].is_fluorescent());
}

TEST_F(SlabDyes, AbsorptionFollowsTexturesToo) {
    const std::string texture = "[[texture]]\nname = \"t\"\ntype = \"noise\"\n[material]\n";
    const std::string keys = "absorption = { texture = \"t\", low = 0, high = { gaussian_nm = 450, "
                             "sigma_nm = 20, scale = 4 } }\n" +
                             EMISSION;
    const Material middle = load_material(write("m.toml", text(keys, texture)));
    EXPECT_NEAR(middle.stack.layers[0].dyes[0].absorption(450.0), 2.0, 1e-12);
}

TEST_F(SlabDyes, NumbersOutOfRangeAreRefusedAtTheirKeys) {
    expect_error(text("absorption = -1\n" + EMISSION), 5, 1, "at least 0");
    expect_error(text(BAND + "concentration = -0.5"), 7, 1, "concentration is -0.5");
    expect_error(text(BAND + "concentration = nan"), 7, 1, "concentration is nan");
    expect_error(text(BAND + "concentration = inf"), 7, 1, "concentration is inf");
    expect_error(text(BAND + "quantum_yield = 1.01"), 7, 1, "at most 1");
    expect_error(text(BAND + "quantum_yield = -0.1"), 7, 1, "at least 0");
    expect_error(text(ABSORPTION + "emission = { nm = [400, 500], value = [-1, 1] }"), 6, 1,
                 "goes down to -1");
    expect_error(text(ABSORPTION + "emission = 0"), 6, 1, "emission is zero");
    expect_error(text(BAND + "concentration = { texture = \"t\", low = -1 }",
                      "[[texture]]\nname = \"t\"\ntype = \"noise\"\n[material]\n"),
                 10, 1, "reaches -1");
}

TEST_F(SlabDyes, MissingUnknownAndContradictoryKeysAreRefused) {
    expect_error(text(EMISSION), 4, 1, "has no \"absorption\"");
    expect_error(text("absorption = 1"), 4, 1, "add emission = ... or shares");
    expect_error(text(BAND + "excitation = 1"), 7, 1, "unknown key \"excitation\"");
    expect_error(text(BAND + "quantum_yeild = 1"), 7, 1, "did you mean \"quantum_yield\"?");
    put_shares(GOOD_ROWS);
    expect_error(text(SHARES + "\n" + EMISSION), 7, 1, "both shares and emission");
    expect_error(text(SHARES + "\nquantum_yield = 1"), 7, 1, "both shares and quantum_yield");
    expect_error(text("absorption = 1\nshares = \"p.csv\""), 6, 1, "write a table");
    expect_error(text("absorption = 1\nshares = { matrix = \"p.csv\" }"), 6, 12,
                 "use one of: file");
    expect_error(text("absorption = 1\nshares = { file = \"no.csv\" }"), 6, 12,
                 "cannot open \"no.csv\"");
    expect_error("[material]\n[[material.layer]]\nior = 1.5\nfluorophores = 3\n", 4, 1,
                 "write an array of tables");
}

TEST_F(SlabDyes, TooManyAreRefused) {
    std::string many = BAND;
    for (int i = 1; i < 65; ++i)
        many += "[[material.layer.fluorophores]]\n" + BAND;
    expect_error(text(many), 4, 18, "65 fluorophores");
}

TEST_F(SlabDyes, SharesThatSendOutMoreThanIsAbsorbedAreRefusedWithTheColumn) {
    put_shares("400,0.1,0,0\n500,0.4,0.4,0\n600,0.3,0.60001,0\n");
    expect_error(text(SHARES), 6, 12, "the column of excitation 500 nm");
    put_shares("400,0.1,0,0\n500,0.4,0.4,0\n600,0.3,0.6000005,0\n"); // within rounding
    EXPECT_TRUE(dye(SHARES).shares);
    put_shares("400,0.1,0,0\n500,-0.4,0.4,0\n600,0.3,0.6,0\n");
    expect_error(text(SHARES), 6, 12, "excitation 400 nm, emission 500 nm is negative");
}

TEST_F(SlabDyes, SharesThatAreNoMatrixAreRefusedInTheirFile) {
    put_shares("400,0.1,0,0\n500,0.4,x,0\n600,0.3,0.6,0\n");
    const auto file = write("m.toml", text(SHARES));
    const Caught error = error_of([&] { load_material(file); });
    EXPECT_EQ(error.exit_code, 2);
    EXPECT_EQ(error.file, (folder / "p.csv").string());
    EXPECT_EQ(error.line, 6) << error.text;
    EXPECT_EQ(error.column, 9) << error.text;
}

TEST_F(SlabDyes, SharesOfMorePhotonsThanAreAbsorbedAreWarnedOf) {
    put_shares("400,0.1,0,0\n500,0.4,0,0\n600,0.3,1,0\n"); // 500 nm to 600 nm: 1.2 photons
    const auto given = warnings(SHARES);
    ASSERT_EQ(given.size(), 1u);
    EXPECT_NE(given[0].find("m.toml:6:12"), std::string::npos) << given[0];
    EXPECT_NE(given[0].find("more photons"), std::string::npos) << given[0];
    put_shares(GOOD_ROWS);
    EXPECT_TRUE(warnings(SHARES).empty());
}

TEST_F(SlabDyes, ADyeThatSendsOutNothingIsWarnedOf) {
    const auto given = warnings("absorption = { line_nm = 600, width_nm = 20 }\n"
                                "emission = { line_nm = 500, width_nm = 20 }");
    ASSERT_EQ(given.size(), 1u);
    EXPECT_NE(given[0].find("m.toml:6:1: "), std::string::npos) << given[0];
    EXPECT_NE(given[0].find("emits up to 510 nm and absorbs from 590 nm on"), std::string::npos)
        << given[0];
    put_shares("400,0.1,0,0\n500,0.4,0,0\n600,0.2,0,0\n");
    const auto of_shares = warnings("absorption = { line_nm = 500, width_nm = 20 }\n"
                                    "shares = { file = \"p.csv\" }");
    ASSERT_EQ(of_shares.size(), 1u);
    EXPECT_NE(of_shares[0].find("zero wherever"), std::string::npos) << of_shares[0];
    // A yield of zero is meant so, and one wavelength in common is enough.
    EXPECT_TRUE(warnings("absorption = { line_nm = 600, width_nm = 20 }\nquantum_yield = 0\n"
                         "emission = { line_nm = 500, width_nm = 20 }")
                    .empty());
    EXPECT_TRUE(warnings("absorption = { line_nm = 500, width_nm = 20 }\n"
                         "emission = { line_nm = 500, width_nm = 20 }")
                    .empty());
}

TEST_F(SlabDyes, BandsOfMatricesMustAgreeWhereNoneAreNamed) {
    put_shares(GOOD_ROWS);
    write("q.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                   "nm,400,450\n400,0.5,0\n450,0.2,0.5\n");
    const Material read =
        load_material(write("m.toml", replaced(text(SHARES), "reflectance = 0.5",
                                               "reradiation = { file = \"q.csv\" }")));
    EXPECT_EQ(matrices_of(read).size(), 2u);
    EXPECT_EQ(common_grid(matrices_of(read)), std::nullopt);
}
