#include "host/scene/model/closed_model.h"
#include "reradiant/scene_file.h"
#include "tests/scene/scratch.h"

using namespace reradiant;
using namespace reradiant::testing;

namespace {

class Sheets : public Scratch {
protected:
    Material material(const std::string& rest) const {
        return load_material(write("m.toml", text(rest)));
    }
    /// The keys given stand from line 6 on.
    static std::string text(const std::string& rest) {
        return "[material]\n[[material.layer]]\nior = 1.5\n[material.substrate]\n"
               "type = \"none\"\n" +
               rest;
    }
    void expect_error(const std::string& content, int line, int column,
                      const std::string& message) const {
        const auto file = write("m.toml", content);
        const Caught error = error_of([&] { load_material(file); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_EQ(error.line, line) << error.text;
        EXPECT_EQ(error.column, column) << error.text;
        EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
    }
};

} // namespace

TEST_F(Sheets, WithoutASubstrateTheLowerFaceIsSmooth) {
    const Material sheet = material("");
    EXPECT_EQ(sheet.substrate.type, SubstrateType::None);
    EXPECT_TRUE(sheet.stack.is_sheet());
    EXPECT_TRUE(sheet.stack.is_smooth());
    EXPECT_FALSE(sheet.is_fluorescent());
    EXPECT_EQ(sheet.stack.lower_face->alpha, 0.0);
    EXPECT_EQ(sheet.stack.lower_face->distribution, Distribution::Ggx);
    EXPECT_EQ(sheet.stack.lower_face->scattering, Scattering::Multiple);
    // An interface, the slab, and the interface to the air: nothing beneath.
    const StackElements elements = material_at(sheet, 550.0);
    ASSERT_EQ(elements.size(), 3u);
    EXPECT_EQ(std::get<SurfaceValues>(elements[2]).ior_above, 1.5);
    EXPECT_EQ(std::get<SurfaceValues>(elements[2]).ior_below, 1.0);
}

TEST_F(Sheets, TheLowerFaceIsReadAsInterfacesAre) {
    const LowerFace rough =
        *material("[material.back]\nroughness_deg = 10\ndistribution = \"beckmann\"\n"
                  "scattering = \"single\"\n")
             .stack.lower_face;
    EXPECT_EQ(rough.distribution, Distribution::Beckmann);
    EXPECT_EQ(rough.alpha, alpha_from_roughness_deg(Distribution::Beckmann, 10.0));
    EXPECT_EQ(rough.scattering, Scattering::Single);
    const Material sheet = material("[material.back]\nalpha = 0.3\n");
    EXPECT_EQ(sheet.stack.lower_face->alpha, 0.3);
    EXPECT_FALSE(sheet.stack.is_smooth());
}

TEST_F(Sheets, ThickSheetsHaveDyesFlakesAndFilms) {
    const Material sheet = load_material(write(
        "m.toml", replaced(text(""), "ior = 1.5",
                           "ior = 1.5\nfilm = { thickness_nm = 300, ior = 1.4 }\n"
                           "flakes = { coverage = 0.2, metal = \"silver\", alpha = 0.1 }\n"
                           "fluorophores = [ { absorption = 1, emission = { gaussian_nm = 600, "
                           "sigma_nm = 20 } } ]")));
    EXPECT_TRUE(sheet.stack.has_flakes());
    EXPECT_TRUE(sheet.stack.has_films());
    EXPECT_TRUE(sheet.is_fluorescent());
}

TEST_F(Sheets, KeysOfSubstratesAreRefused) {
    expect_error(text("reflectance = 0.5\n"), 6, 1, "nothing has no reflectance");
    expect_error(text("sigma = 0.3\n"), 6, 1, "nothing has no sigma");
    expect_error(text("alpha = 0.3\n"), 6, 1, "[material.back]");
    expect_error(text("pigments = []\n"), 6, 1, "nothing has no pigments");
    expect_error(text("kapa = 1\n"), 6, 1, "unknown key \"kapa\"");
}

TEST_F(Sheets, ALowerFaceIsForSheetsOnly) {
    for (const char* substrate : {"type = \"lambert\"\n", "type = \"oren-nayar\"\nsigma = 0.3\n",
                                  "type = \"conductor\"\nmetal = \"gold\"\n"})
        expect_error(std::string("[material]\n[material.back]\nalpha = 0.1\n"
                                 "[material.substrate]\n") +
                         substrate,
                     2, 11, "only a sheet has a lower face");
}

TEST_F(Sheets, WrongLowerFacesAreRefused) {
    expect_error(text("[material.back]\nalpha = 2\n"), 7, 1, "at most 1");
    expect_error(text("[material.back]\nalpha = 0.1\nroughness_deg = 3\n"), 7, 1, "both");
    expect_error(text("[material.back]\nior = 1.5\n"), 7, 1, "unknown key \"ior\"");
    expect_error(text("[material.back]\ndistribution = \"phong\"\n"), 7, 1, "blinn, beckmann, ggx");
    expect_error(
        "[material]\nback = 1\nlayer = [ { ior = 1.5 } ]\nsubstrate = { type = \"none\" }\n", 2, 1,
        "write a table");
}

TEST_F(Sheets, ASheetNeedsALayer) {
    expect_error("[material]\n[material.substrate]\ntype = \"none\"\n", 2, 11,
                 "at least one [[material.layer]]");
}

TEST_F(Sheets, ModelsThatFollowNoLightBetweenSlabsAreRefusedAtTheirKey) {
    expect_error("[material]\nmodel = \"weidlich-wilkie\"\nlayer = [ { ior = 1.5 } ]\n"
                 "substrate = { type = \"none\" }\n",
                 2, 1, "it follows no light between the slabs");
    expect_error("[material]\nmodel = \"weidlich-wilkie\"\nlayer = [ { ior = 1.5, fluorophores = [ "
                 "{ absorption = 1, emission = { gaussian_nm = 600, sigma_nm = 20 } } ] } ]\n"
                 "substrate = { type = \"lambert\" }\n",
                 2, 1, "it follows no light between the slabs");
}

TEST_F(Sheets, LayersOfASheetAreNoneToLookThrough) {
    const auto refused = [&](const std::string& content, int line, int column,
                             const std::string& message) {
        const auto file = write("s.toml", content);
        const Caught error = error_of([&] { load_stack(file); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_EQ(error.line, line) << error.text;
        EXPECT_EQ(error.column, column) << error.text;
        EXPECT_NE(error.text.find(message), std::string::npos) << error.text;
    };
    refused(text(""), 4, 11, "no substrate to look through to");
    refused("[material]\n[[material.layer]]\nior = 1.5\n[material.back]\nalpha = 0.1\n", 4, 11,
            "no substrate to look through to");
    const std::string dye = "[[material.layer.fluorophores]]\nabsorption = 1\n"
                            "emission = { gaussian_nm = 600, sigma_nm = 20 }\n";
    refused("[material]\n[[material.layer]]\nior = 1.5\n" + dye, 4, 18, "light of their own");
    const LayerStack clear = load_stack(write(
        "s.toml", "[material]\n[[material.layer]]\nior = 1.5\n" + dye + "concentration = 0\n"));
    EXPECT_FALSE(clear.is_dyed());
}
