#include "host/film/display/png.h"
#include "host/report/data_uri.h"
#include "host/report/polar_plot.h"
#include "host/study/page/contact_sheet.h"
#include "host/study/page/study_page.h"
#include "host/study/study/study_store.h"
#include "tests/study/study_fixtures.h"

#include <algorithm>
#include <limits>

namespace reradiant {
namespace {

class StudyPage : public test::StudyTest {
protected:
    /// Two cells: one measured and with an image, one that failed.
    StudyResult result() const {
        StudyResult result;
        CellResult done;
        done.labels = {"1"};
        done.folder = folder / "cells" / "0000";
        SpectralImage image;
        image.width = 2;
        image.height = 1;
        image.bands = {500.0, 50.0, 2};
        image.values = {0.25f, 1.0f, 0.0f, 4.0f};
        keep_image(done, image, 0.0);
        CellMeasurement measurement;
        measurement.bands = image.bands;
        measurement.matrix = Eigen::Matrix2d{{0.5, 0.0}, {0.25, 0.125}};
        measurement.specular = {0.0, 0.0};
        measurement.colours = {{"D65",
                                45.0,
                                0.0,
                                0.0,
                                {1.0, 2.0, 3.0},
                                {4.0, 5.0, 6.0},
                                {0.5, std::numeric_limits<double>::quiet_NaN()},
                                0.75}};
        measurement.polar = {{45.0, {-45.0, 0.0, 45.0}, {0.5, 0.5, 0.5}, {0.5, 0.6, 8.0}}};
        done.measurement = measurement;
        CellResult failed;
        failed.index = 1;
        failed.labels = {"2"};
        failed.folder = folder / "cells" / "0001";
        failed.error = "went wrong </script><b>";
        result.cells = {done, failed};
        return result;
    }
    Study study() const {
        return load(head + "title = \"A <study>\"\n[[sweep]]\nparameter = \"thickness\"\n"
                           "values = [1, 2]\n");
    }
};

nlohmann::json embedded(const std::string& page) {
    const std::string mark = "id=\"study-data\">";
    const std::size_t start = page.find(mark) + mark.size();
    return nlohmann::json::parse(page.substr(start, page.find("</script>", start) - start));
}

TEST_F(StudyPage, NeedsNothingFromOutside) {
    std::string page = study_page(study(), result());
    // SVG names its namespace by a URL that nothing fetches.
    const std::string name_space = "http://www.w3.org/2000/svg";
    for (std::size_t at; (at = page.find(name_space)) != std::string::npos;)
        page.erase(at, name_space.size());
    for (const char* reference : {"http:", "https:", "src=\"", "href=\"", "@import", "url(",
                                  "fetch(", "XMLHttpRequest", "import("})
        EXPECT_EQ(page.find(reference), std::string::npos) << reference;
    for (const char* part : {"id=\"sheet\"", "id=\"controls\"", "id=\"panels\"", "<noscript>",
                             "<title>A &lt;study&gt;</title>"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST_F(StudyPage, HoldsWhatWasRenderedAndMeasured) {
    const nlohmann::json json = embedded(study_page(study(), result()));
    ASSERT_EQ(json.at("cells").size(), 2u);
    const nlohmann::json& image = json.at("cells")[0].at("image");
    EXPECT_EQ(image.at("largest"), 4.0);
    // Codes of 0.25/4, 1/4, 0, 1: square roots 0.25, 0.5, 0, 1 of 65535, little-endian.
    const unsigned char codes[] = {0x00, 0x40, 0x00, 0x80, 0x00, 0x00, 0xff, 0xff};
    EXPECT_EQ(image.at("codes"), base64({reinterpret_cast<const char*>(codes), sizeof(codes)}));
    EXPECT_TRUE(image.at("picture").get<std::string>().starts_with("data:image/png;base64,iVBOR"));
    const nlohmann::json& measured = json.at("cells")[0].at("measured");
    EXPECT_EQ(measured.at("colours")[0].at("XYZ")[1], 2.0);
    EXPECT_TRUE(measured.at("colours")[0].at("beta_T")[1].is_null());
    EXPECT_NE(measured.at("polar")[0].get<std::string>().find("<svg"), std::string::npos);
}

TEST_F(StudyPage, SweptNumbersHaveTheirUnits) {
    const std::string sweeps = "[[sweep]]\nparameter = \"thickness\"\nvalues = [1, 2]\n"
                               "[[sweep]]\nparameter = \"roughness\"\nvalues = [5]\n"
                               "[[sweep]]\nparameter = \"absorption\"\nvalues = [0.5]\n"
                               "[[sweep]]\nparameter = \"angle\"\nvalues = [20]\n"
                               "[[sweep]]\nparameter = \"illuminant\"\nvalues = [{ line_nm = "
                               "405, width_nm = 2, scale = 9 }]\n";
    const Study swept = load(head + sweeps);
    CellResult cell;
    cell.index = 1;
    EXPECT_EQ(cell_name(swept, cell),
              "thickness = 2 units, roughness = 5 deg, absorption = 0.5 per unit of thickness, "
              "angle = 20 deg, illuminant = 405 nm");
    const Study named = load(head + "[[sweep]]\nparameter = \"thickness\"\nvalues = [1, 2]\n"
                                    "names = [\"thin\", \"thick\"]\n");
    EXPECT_EQ(cell_name(named, cell), "thickness = thick");
    const std::string page = study_page(study(), result());
    EXPECT_EQ(embedded(page).at("sweeps")[0].at("values")[0], "1 unit");
    EXPECT_NE(page.find("absorption and scattering are given per such a unit"), std::string::npos);
}

TEST_F(StudyPage, FailedCellIsShownAndItsTextCannotBecomeMarkup) {
    const std::string page = study_page(study(), result());
    EXPECT_EQ(page.find("</script><b>"), std::string::npos);
    EXPECT_EQ(embedded(page).at("cells")[1].at("error"), "went wrong </script><b>");
}

TEST_F(StudyPage, TableHasARowForTheImageAndForTheColour) {
    write_study_table(folder / "table.csv", study(), result());
    std::ifstream stream(folder / "table.csv");
    std::string head_line, rendered, measured, more;
    std::getline(stream, head_line);
    std::getline(stream, rendered);
    std::getline(stream, measured);
    EXPECT_EQ(head_line, "cell,thickness,source,illuminant,theta_i_deg,theta_o_deg,phi_deg,X,Y,Z,L,"
                         "a,b,quantum_yield,reflected,transmitted,guided,beta_T_500nm,"
                         "beta_T_550nm");
    EXPECT_TRUE(rendered.starts_with("0,1,rendered,,,,,")) << rendered;
    EXPECT_EQ(measured, "0,1,measured,D65,45,0,0,1,2,3,4,5,6,0.75,,,,0.5,");
    EXPECT_FALSE(std::getline(stream, more)) << "no row for a cell that failed";
    const auto fields = [](const std::string& line) {
        return std::count(line.begin(), line.end(), ',');
    };
    EXPECT_EQ(fields(rendered), fields(head_line));
}

TEST_F(StudyPage, WhatSheetsTransmitIsKeptAndShown) {
    StudyResult both = result();
    CellMeasurement& measured = *both.cells[0].measurement;
    measured.transmitted = Eigen::Matrix2d{{0.25, 0.0}, {0.125, 0.5}};
    measured.guided = Eigen::Matrix2d{{0.0, 0.0}, {0.0625, 0.0}};
    measured.straight = {0.125, 0.25};
    measured.colours[0].transmitted = 75.0;
    keep_cell(both.cells[0], "same");
    CellResult restored = both.cells[0];
    restored.measurement.reset();
    ASSERT_TRUE(restore_cell(restored, "same"));
    EXPECT_EQ(restored.measurement->transmitted, measured.transmitted);
    EXPECT_EQ(restored.measurement->guided, measured.guided);
    EXPECT_EQ(restored.measurement->straight, measured.straight);
    EXPECT_EQ(restored.measurement->colours[0].transmitted, 75.0);
    EXPECT_TRUE(std::filesystem::exists(restored.folder / "transmitted.csv"));
    EXPECT_TRUE(std::filesystem::exists(restored.folder / "transmitted.svg"));
    const std::vector<float> entries{0.25f, 0.125f, 0.0f, 0.5f};
    EXPECT_EQ(embedded(study_page(study(), both)).at("cells")[0].at("measured").at("transmitted"),
              base64({reinterpret_cast<const char*>(entries.data()), 16}));
}

TEST_F(StudyPage, CellsAreRestoredUnlessTheyAreOfAnotherIdentityOrDamaged) {
    const CellResult kept = result().cells[0];
    keep_cell(kept, "same");
    CellResult restored = kept;
    restored.measurement.reset();
    ASSERT_TRUE(restore_cell(restored, "same"));
    EXPECT_TRUE(restored.kept);
    EXPECT_EQ(restored.measurement->matrix, kept.measurement->matrix);
    EXPECT_EQ(restored.measurement->colours[0].xyz, kept.measurement->colours[0].xyz);
    EXPECT_EQ(restored.measurement->polar[0].total, kept.measurement->polar[0].total);
    EXPECT_FALSE(restore_cell(restored, "other"));
    std::filesystem::resize_file(kept.folder / "image.exr", 100);
    EXPECT_FALSE(restore_cell(restored, "same"));
    std::filesystem::resize_file(kept.folder / "cell.json", 20);
    EXPECT_FALSE(restore_cell(restored, "same"));
}

TEST_F(StudyPage, SheetRunsTheLastSweepsAcross) {
    const Study three = load(head + "[[sweep]]\nparameter = \"thickness\"\nvalues = [1, 2]\n"
                                    "[[sweep]]\nparameter = \"ior\"\nvalues = [1.3, 1.4, 1.5]\n"
                                    "[[sweep]]\nparameter = \"angle\"\nvalues = [5, 60]\n");
    const SheetLayout layout = sheet_layout(three);
    EXPECT_EQ(layout.rows, 2u);
    EXPECT_EQ(layout.columns, 6u);
    EXPECT_EQ(layout.row_sweeps, 1u);
    write_contact_sheet(folder / "sheet.png", study(), result());
    EXPECT_TRUE(png_data_uri(folder / "sheet.png").size() > 100);
}

TEST(DataUri, Base64IsThatOfRfc4648) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(PolarPlot, LengthsMustAgreeAndGapsAreLeftOut) {
    EXPECT_THROW(svg::polar_plot("t", {{"a", {0.0, 10.0}, {1.0}}}, 45.0), std::invalid_argument);
    const std::string plot =
        svg::polar_plot("t", {{"a", {-10.0, 0.0, 10.0, 20.0}, {1.0, 0.0, 1.0, 1.0}}}, 45.0);
    EXPECT_EQ(plot.find("nan"), std::string::npos);
    EXPECT_EQ(plot.find("inf"), std::string::npos);
}

} // namespace
} // namespace reradiant
