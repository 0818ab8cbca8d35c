#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

using namespace reradiant;

namespace {

const std::string stack_text = "[material]\n"
                               "  [[material.layer]]\n"
                               "  ior = 1.5\n"
                               "  [material.substrate]\n"
                               "  type = \"lambert\"\n"
                               "  reflectance = 0.9\n";

const std::string recipe_text = "emission_nm = { from = 440, to = 660, step = 20 }\n"
                                "excitation_nm = { from = 400, to = 660, step = 20 }\n"
                                "reflectance = 0.9\n"
                                "[[material.layer]]\n"
                                "ior = 1.5\n"
                                "  [[material.layer.fluorophores]]\n"
                                "  absorption = { gaussian_nm = 470, sigma_nm = 25, scale = 1 }\n"
                                "  emission = { gaussian_nm = 540, sigma_nm = 25, scale = 1 }\n"
                                "  quantum_yield = 0.8\n"
                                "[geometry]\n"
                                "theta_i_deg = [45]\ntheta_o_deg = [0]\nphi_deg = [0]\n"
                                "[noise]\nread_of_peak = 0.005\n";

class FitDyes : public ProgramTest {
protected:
    void SetUp() override {
        put("stack.toml", stack_text);
        put("recipe.toml", recipe_text);
    }
};

} // namespace

TEST_F(FitDyes, FindsTheDyeAndWritesWhatItFound) {
    ASSERT_EQ(run("synth recipe.toml -o data.csv --seed 1").exit_code, 0);
    const ProgramResult fitted =
        run("fit data.csv -o matrix.csv --stack stack.toml --dye 1 --rank 1 --json fit.json "
            "--report page.html --model-file dyed.toml");
    ASSERT_EQ(fitted.exit_code, 0) << fitted.errors;
    const auto json = nlohmann::json::parse(file_bytes(folder / "fit.json"));
    EXPECT_EQ(json["model"], "dyes");
    EXPECT_TRUE(json["converged"]);
    const auto& yield = json["quantum_yield"][0];
    EXPECT_NEAR(yield["value"], 0.8, 0.02); // its standard error is 0.004
    EXPECT_LT(yield["low"], yield["high"]);
    EXPECT_EQ(json["dyes"][0]["absorption"].size(), json["bands_nm"].size());
    EXPECT_EQ(json["evidence"][0]["dyes"], 1);
    EXPECT_NE(file_bytes(folder / "page.html").find("residuals by excitation"), std::string::npos);
    for (const std::string written : {"dyed.toml", "matrix.csv"})
        EXPECT_EQ(run("validate " + written).exit_code, 0) << written;
    const ProgramResult measured = run("measure dyed.toml -o again.csv --theta-i 45 --theta-o 0 "
                                       "--bands 400:660:20");
    EXPECT_EQ(measured.exit_code, 0) << measured.errors;
    EXPECT_EQ(run("fit again.csv -o other.csv --stack stack.toml --dye 1 --rank 1").exit_code, 0)
        << "light of the slab and of the ground is taken together";
}

TEST_F(FitDyes, FitsASeriesTogether) {
    for (const std::string thickness : {"0.3", "2"})
        ASSERT_EQ(
            run("synth recipe.toml -o at-" + thickness + ".csv --thickness " + thickness).exit_code,
            0);
    const ProgramResult fitted = run("fit at-0.3.csv at-2.csv -o matrix.csv --stack stack.toml "
                                     "--dye 1 --thickness 0.3,2 --rank 1 --json fit.json");
    ASSERT_EQ(fitted.exit_code, 0) << fitted.errors;
    const auto json = nlohmann::json::parse(file_bytes(folder / "fit.json"));
    EXPECT_NEAR(json["dyes"][0]["peak_depth"]["value"], 2.0 * 0.923, 0.06); // at 460 or 480 nm
}

TEST_F(FitDyes, BadInputIsRefused) {
    ASSERT_EQ(run("synth recipe.toml -o data.csv --seed 1").exit_code, 0);
    const std::string fit = "fit data.csv -o matrix.csv ";
    expect_failure(2, fit + "--dye 1", "none is given");
    expect_failure(2, fit + "--stack stack.toml --dye 2", "stack.toml: --dye 2: the stack has 1");
    expect_failure(2, fit + "--stack stack.toml --dye top", "--dye top is no layer");
    expect_failure(2, fit + "--stack stack.toml --dye 1 --thickness -1", "--thickness -1");
    expect_failure(2, fit + "--stack stack.toml --dye 1 --unit percent", "--unit");
    expect_failure(2, fit + "--stack stack.toml --dye 1 --lamp stack.toml", "stack.toml");
    expect_failure(2, fit + "--unit arbitrary", "--unit is for dyes in a layer");
    expect_failure(2, fit + "--stack stack.toml --dye 1 --mask box:300-800x300-800",
                   "leaves no entry");
    expect_failure(2, "fit data.csv data.csv -o matrix.csv", "several data sets");
    expect_failure(2, fit + "--stack stack.toml --dye 1 --anti-stokes", "--anti-stokes");
}
