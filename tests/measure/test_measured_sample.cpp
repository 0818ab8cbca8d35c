#include "host/measure/measured_sample.h"

#include "reradiant/error.h"
#include "reradiant/measure.h"
#include "reradiant/scene_file.h"
#include "tests/support/scratch_folder.h"

#include <fmt/format.h>

using namespace reradiant;

namespace {

constexpr const char* headings =
    "theta_i_deg,theta_o_deg,phi_deg,lambda_i_nm,lambda_o_nm,value,stderr,part\n";

Material preset(const std::string& name) {
    return load_material(std::filesystem::path(RERADIANT_SOURCE_DIR) / "spectra" / "materials" /
                         (name + ".toml"));
}

class MeasuredSampleTest : public test::ScratchFolder {
protected:
    std::filesystem::path measured(const Material& material, const MeasureRequest& request) const {
        write_measurement(path("measured.csv"), measure_material(material, request));
        return path("measured.csv");
    }
    /// The text of the input Error of a file of rows in a geometry; empty where there is none.
    std::string refusal(const std::string& text, const std::string& geometry) const {
        try {
            MeasuredSample(write("rows.csv", text)).seen_in(viewing_geometry(geometry));
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2);
            return error.what();
        }
        return "";
    }
};

void expect_equal(const ReradiationMatrix& seen, const ReradiationMatrix& expected) {
    ASSERT_EQ(seen.emission, expected.emission);
    ASSERT_EQ(seen.excitation, expected.excitation);
    // The file has twelve digits.
    EXPECT_LT((seen.values - expected.values).cwiseAbs().maxCoeff(), 1e-11);
}

} // namespace

TEST_F(MeasuredSampleTest, DirectionsAreThoseOfTheMaterialItself) {
    for (const char* name : {"neon-orange-varnished", "fluorescent-orange-rough", "glossy-paint"}) {
        const Material material = preset(name);
        MeasureRequest request;
        request.theta_i_deg = {0.0, 45.0};
        request.theta_o_deg = {0.0, 45.0, 60.0};
        request.phi_deg = {0.0, 120.0};
        const MeasuredSample sample(measured(material, request));
        for (const char* geometry : {"45/0", "0/45", "45:60:120", "45:60:-240", "0:60:77"})
            expect_equal(sample.seen_in(viewing_geometry(geometry)),
                         geometry_matrix(material, viewing_geometry(geometry)));
        EXPECT_THROW(sample.seen_in(viewing_geometry("45:30")), Error);
        EXPECT_THROW(sample.seen_in(viewing_geometry("45:60:240")), Error);
    }
}

TEST_F(MeasuredSampleTest, HemispheresAreThoseOfTheMaterialItself) {
    MeasureRequest request;
    request.theta_i_deg = {8.0};
    request.hemispherical = true;
    const ViewingGeometry included = viewing_geometry("8/d"), excluded = viewing_geometry("8/de"),
                          reversed = viewing_geometry("d/8");
    const Material orange = preset("fluorescent-orange-smooth");
    const MeasuredSample sample(measured(orange, request));
    expect_equal(sample.seen_in(included), geometry_matrix(orange, included));
    EXPECT_THROW(sample.seen_in(excluded), Error) << "how wide the lobe is";
    EXPECT_THROW(sample.seen_in(reversed), Error) << "the transpose is another matrix";
    const Material bare = preset("neon-orange-bare");
    expect_equal(MeasuredSample(measured(bare, request)).seen_in(excluded),
                 geometry_matrix(bare, excluded));
    const Material paint = preset("glossy-paint");
    expect_equal(MeasuredSample(measured(paint, request)).seen_in(reversed),
                 geometry_matrix(paint, reversed));
}

TEST_F(MeasuredSampleTest, ADirectionThatWasNotMeasuredListsThoseThatWere) {
    const std::string two = std::string(headings) + "45,20,180,500,500,0.1,0,diffuse\n"
                                                    "45,60,0,500,500,0.1,0,diffuse\n";
    const std::string other = refusal(two, "45/0");
    for (const char* part : {"the geometry 45/0", "45:20:180, 45:60:0", "nothing is interpolated",
                             "--theta-i 45 --theta-o 0 --phi 0"})
        EXPECT_NE(other.find(part), std::string::npos) << part << '\n' << other;
    const std::string sphere = refusal(two, "8/d");
    EXPECT_NE(sphere.find("--hemispherical --theta-i 8"), std::string::npos) << sphere;
    EXPECT_EQ(sphere.find("ask for one of these"), std::string::npos) << sphere;
    std::string many = headings;
    for (int theta = 0; theta < 30; ++theta)
        many += fmt::format("45,{},180,500,500,0.1,0,diffuse\n", theta + 1);
    EXPECT_NE(refusal(many, "45/0").find("and 6 more"), std::string::npos);
}

TEST_F(MeasuredSampleTest, PartsAddUpAndWhatIsTransmittedIsNoReflection) {
    const MeasuredSample sample(write("parts.csv", std::string(headings) +
                                                       "8,,,500,500,0.4,0,diffuse\n"
                                                       "8,,,500,500,0.2,0,slab\n"
                                                       "8,,,500,500,0.1,0,specular\n"
                                                       "8,,,500,500,0.05,0,transmitted\n"
                                                       "8,,,500,500,0.05,0,guided\n"));
    EXPECT_NEAR(sample.seen_in(viewing_geometry("8/d")).values(0, 0), 0.7, 1e-12);
}

TEST_F(MeasuredSampleTest, EntriesThatLightCannotReachMayBeMissing) {
    const std::string below = std::string(headings) + "45,0,0,400,400,0.1,0,diffuse\n"
                                                      "45,0,0,400,500,0.2,0,diffuse\n"
                                                      "45,0,0,500,500,0.1,0,diffuse\n";
    EXPECT_EQ(refusal(below, "45/0"), "");
    const std::string gap = std::string(headings) + "45,0,0,400,400,0.1,0,diffuse\n"
                                                    "45,0,0,400,500,0.2,0,diffuse\n"
                                                    "45,0,0,400,600,0.2,0,diffuse\n"
                                                    "45,0,0,500,500,0.1,0,diffuse\n"
                                                    "45,0,0,600,600,0.1,0,diffuse\n";
    EXPECT_NE(refusal(gap, "45/0").find("excitation 500 nm, emission 600 nm is missing"),
              std::string::npos);
}

TEST_F(MeasuredSampleTest, BadRowsAreRefusedAtTheirPlace) {
    const auto with = [&](const std::string& row) { return refusal(headings + row, "45/0"); };
    EXPECT_NE(with("45,0,0,400,400,nan,0,diffuse\n").find("rows.csv:2:1: "), std::string::npos);
    EXPECT_NE(with("45,0,0,400,400,1,0,diffuse\n45,0,0,400,400,1,0,diffuse\n").find(":3:1: "),
              std::string::npos);
    EXPECT_NE(with("45,0,0,400,400,1,0,shiny\n").find(":2:20: 'shiny'"), std::string::npos)
        << with("45,0,0,400,400,1,0,shiny\n");
    EXPECT_NE(with("185,0,0,400,400,1,0,diffuse\n").find(":2:1: 185 degrees"), std::string::npos);
    EXPECT_NE(with("45,0,0,400,400,1,0\n").find("7 values"), std::string::npos);
    EXPECT_NE(with("45,,0,400,400,1,0,diffuse\n").find(":2:"), std::string::npos);
    EXPECT_NE(with("").find("no row of a measurement"), std::string::npos);
    EXPECT_NE(with("45,0,0,5,5,1,0,diffuse\n").find("cannot be in nm"), std::string::npos);
    EXPECT_NE(refusal("theta_i_deg,value\n1,2\n", "45/0").find("headings are not known"),
              std::string::npos);
}
