#include "tests/study/study_fixtures.h"

namespace reradiant {
namespace {

using StudyFile = test::StudyTest;

TEST_F(StudyFile, CellsAreAllCombinationsAndTheLastSweepRunsFastest) {
    const Study study = load(head + "[[sweep]]\nparameter = \"thickness\"\nvalues = [1, 2, 3]\n"
                                    "[[sweep]]\nparameter = \"angle\"\nvalues = [5, 60]\n");
    EXPECT_EQ(study.cell_count(), 6u);
    EXPECT_EQ(study.cell_values(0), (std::vector<std::size_t>{0, 0}));
    EXPECT_EQ(study.cell_values(1), (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(study.cell_values(5), (std::vector<std::size_t>{2, 1}));
    EXPECT_TRUE(study.rendering.has_value()) << "a study that asks for nothing renders";
}

TEST_F(StudyFile, EmptySweepsAreRefusedAtTheirPlace) {
    EXPECT_TRUE(refusal(head).starts_with("study.toml:1:1: the study sweeps nothing"));
    EXPECT_TRUE(refusal(head + "[[sweep]]\nparameter = \"ior\"\nvalues = []\n")
                    .starts_with("study.toml:5:1: the sweep is empty"));
    EXPECT_TRUE(refusal(head + "[[sweep]]\nparameter = \"ior\"\n")
                    .starts_with("study.toml:3:1: [[sweep]] has no \"values\""));
}

TEST_F(StudyFile, ContradictorySweepsAreRefusedAtTheSecond) {
    const auto two = [&](const std::string& first, const std::string& second) {
        return refusal(head + "[[sweep]]\n" + first + "\n[[sweep]]\n" + second + "\n");
    };
    const std::string thickness = "parameter = \"thickness\"\nvalues = [1, 2]";
    EXPECT_TRUE(two(thickness, thickness).starts_with("study.toml:7:1: two sweeps contradict"));
    EXPECT_TRUE(two(thickness, "key = \"material.sample.layer.0.thickness\"\nvalues = [1]")
                    .starts_with("study.toml:7:1: two sweeps contradict"))
        << "another spelling of the same place";
    EXPECT_TRUE(two("parameter = \"roughness\"\nvalues = [1, 2]",
                    "key = \"material.0.layer.0.alpha\"\nvalues = [0.1]")
                    .starts_with("study.toml:7:1: two sweeps contradict"))
        << "two words for roughness";
    EXPECT_TRUE(two("parameter = \"concentration\"\nvalues = [1, 2]",
                    "key = \"material.0.substrate.reradiation\"\nvalues = [0.1]")
                    .starts_with("study.toml:7:1: two sweeps contradict"))
        << "the whole of what the other is a part of";
    EXPECT_TRUE(two("parameter = \"illuminant\"\nvalues = [\"A\"]",
                    "key = \"light.0.radiance.scale\"\nvalues = [1]")
                    .starts_with("study.toml:7:1: two sweeps contradict"));
}

TEST_F(StudyFile, WhatIsSweptCannotBeFixedAsWell) {
    EXPECT_TRUE(refusal(head + "[measure]\ntheta_i_deg = [0]\n[[sweep]]\nparameter = \"angle\"\n"
                               "values = [5]\n")
                    .starts_with("study.toml:6:1: angle is swept"));
    EXPECT_TRUE(refusal(head + "[measure]\nilluminants = [\"A\"]\n[[sweep]]\n"
                               "parameter = \"illuminant\"\nvalues = [\"D65\"]\n")
                    .starts_with("study.toml:6:1: illuminant is swept"));
}

TEST_F(StudyFile, PlacesThatAreNotThereAreRefusedWithWhatIs) {
    const auto one = [&](const std::string& target) {
        return refusal(head + "[[sweep]]\n" + target + "\nvalues = [1]\n");
    };
    EXPECT_TRUE(one("key = \"camera.origin.3\"").starts_with("study.toml:4:1: the scene has no"));
    EXPECT_TRUE(one("key = \"cammera.fov_deg\"").starts_with("study.toml:4:1: the scene has no"));
    EXPECT_NE(one("key = \"cammera.fov_deg\"").find("camera"), std::string::npos);
    EXPECT_TRUE(one("key = \"camera.fov_deg.x\"").starts_with("study.toml:4:1: there is no"));
    EXPECT_TRUE(one("parameter = \"thickness\"\nlayer = 1").starts_with("study.toml:4:1: the sc"));
    EXPECT_TRUE(one("parameter = \"colour\"").starts_with("study.toml:4:1: parameter is"));
    EXPECT_TRUE(one("parameter = \"ior\"\nlight = 0").starts_with("study.toml:5:1: ior is of no"));
    EXPECT_TRUE(one("parameter = \"ior\"\nkey = \"film.width\"").starts_with("study.toml:5:1: bo"));
    EXPECT_TRUE(one("label = \"x\"").starts_with("study.toml:3:1: the sweep has neither"));
    EXPECT_TRUE(one("parameter = \"concentration\"\nlayer = 0")
                    .starts_with("study.toml:4:1: the scene has no \"fluorophores\""));
    EXPECT_TRUE(one("parameter = \"concentration\"\nfluorophore = 1")
                    .starts_with("study.toml:4:1: the scene has no \"1\""));
}

TEST_F(StudyFile, SweepOfWhichNoValueIsRightIsRefusedAtItsFirstValue) {
    EXPECT_TRUE(refusal(head + "[[sweep]]\nparameter = \"ior\"\nvalues = [-1, 0]\n")
                    .starts_with("study.toml:5:11: no value of the sweep ior can be used"));
    // One that is right is enough: the others are cells that fail.
    EXPECT_EQ(load(head + "[[sweep]]\nparameter = \"ior\"\nvalues = [-1, 1.4]\n").cell_count(), 2u);
}

TEST_F(StudyFile, ValuesAreToldApart) {
    EXPECT_TRUE(refusal(head + "[[sweep]]\nparameter = \"ior\"\nvalues = [1.4, 1.5, 1.4]\n")
                    .starts_with("study.toml:5:21: the sweep has the value 1.4 twice"));
    EXPECT_TRUE(refusal(head + "[[sweep]]\nparameter = \"ior\"\nvalues = [1.4, 1.5]\n"
                               "names = [\"thin\"]\n")
                    .starts_with("study.toml:6:1: 1 names for 2 values"));
    const Study named = load(head + "[[sweep]]\nparameter = \"ior\"\nvalues = [1.4, 1.5]\n"
                                    "names = [\"wax\", \"oil\"]\n");
    EXPECT_EQ(named.sweeps[0].values[1].label, "oil");
}

TEST_F(StudyFile, BaseMustBeOneThing) {
    EXPECT_TRUE(refusal("[study]\ntitle = \"x\"\n").starts_with("study.toml:1:1: the study has"));
    EXPECT_TRUE(refusal("[study]\nmaterial = \"no.toml\"\n").starts_with("study.toml:2:1: cannot"));
    EXPECT_TRUE(refusal("[study]\npreset = \"no\"\n").starts_with("study.toml:2:1: no preset"));
    EXPECT_TRUE(refusal("[study]\nmaterial = \"sample.toml\"\npreset = \"a\"\n")
                    .starts_with("study.toml:3:1: a preset"));
    EXPECT_TRUE(refusal("[study]\nsceen = \"a\"\n").starts_with("study.toml:2:1: unknown key"));
}

TEST_F(StudyFile, TooManyCellsAreRefused) {
    std::string text = head;
    for (const char* parameter : {"ior", "thickness", "absorption", "roughness", "angle"}) {
        text += std::string("[[sweep]]\nparameter = \"") + parameter + "\"\nvalues = [";
        for (int i = 0; i < 8; ++i)
            text += std::to_string(1.1 + 0.1 * i) + ", ";
        text += "]\n";
    }
    EXPECT_NE(refusal(text).find("combinations"), std::string::npos);
}

} // namespace
} // namespace reradiant
