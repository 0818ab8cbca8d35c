#include "reradiant/error.h"
#include "reradiant/reradiation.h"
#include "tests/support/scratch_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

using namespace reradiant;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const std::string head = "# reradiation covariance\n# quantity: per-band\n# orientation: "
                         "rows-emission\n# directions: 1\n";
const std::string body = "part,nm,400,410\n"
                         "matrix,400,0.5,0\nmatrix,410,0.01,0.5\n"
                         "independent,400,0.002,0\nindependent,410,nan,0.002\n"
                         "1,400,0,0\n1,410,0.001,0\n";

MatrixCovariance three_directions() {
    MatrixCovariance covariance{{400.0, 10.0, 3},
                                {380.0, 10.0, 4},
                                Eigen::MatrixXd(12, 3),
                                Eigen::MatrixXd::Constant(3, 4, 0.001)};
    for (Eigen::Index k = 0; k < covariance.directions.size(); ++k)
        covariance.directions(k) = 0.01 * std::sin(1.0 + static_cast<double>(k * k));
    return covariance;
}

class CovarianceCsv : public testing::Test {
protected:
    std::filesystem::path put(const std::string& text) const {
        std::ofstream(folder / "c.csv", std::ios::binary) << text;
        return folder / "c.csv";
    }

    /// Expects an input Error at a place that says something.
    void refused(const std::string& text, int line, int column, const std::string& words) const {
        try {
            read_covariance_csv(put(text));
            ADD_FAILURE() << "read: " << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), Error::Kind::Input);
            EXPECT_EQ(error.position().line, line) << error.what();
            EXPECT_EQ(error.position().column, column) << error.what();
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    }

    static std::string changed(std::string text, const std::string& from, const std::string& to) {
        const auto at = text.find(from);
        return at == std::string::npos ? "no " + from : text.replace(at, from.size(), to);
    }

    test::TemporaryFolder folder{"covariance"};
};

} // namespace

TEST_F(CovarianceCsv, IsReadAsItIsWritten) {
    MatrixCovariance covariance = three_directions();
    covariance.independent(1, 2) = unknown;
    covariance.matrix = Eigen::MatrixXd::Constant(3, 4, 1.0 / 3.0);
    const auto file = folder / "c.csv";
    write_covariance_csv(file, covariance);
    const MatrixCovariance read = read_covariance_csv(file);
    EXPECT_EQ(read.emission, covariance.emission);
    EXPECT_EQ(read.excitation, covariance.excitation);
    EXPECT_EQ(*read.matrix, *covariance.matrix);
    // Six digits are written.
    EXPECT_LT((read.directions - covariance.directions).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_TRUE(std::isnan(read.independent(1, 2)));
    EXPECT_EQ(read.independent(0, 0), 0.001);
}

TEST_F(CovarianceCsv, PlainTextHasThePlaceOfWhatIsWrong) {
    const MatrixCovariance read = read_covariance_csv(put(head + body));
    EXPECT_EQ(read.directions.cols(), 1);
    EXPECT_NEAR(read.directions(1, 0), 0.001, 1e-15);
    refused(body, 1, 1, "no covariance");
    refused(head + changed(body, "part,nm", "part,lambda"), 5, 1, "headings");
    refused(head + changed(body, "0.002,0\nindependent,410", "-0.002,0\nindependent,410"), 8, 17,
            "standard error of -0.002");
    refused(head + changed(body, "1,410,0.001,0\n", ""), 10, 1, "ends after 1 rows");
    refused(head + changed(body, "1,410,0.001,0\n", "1,420,0.001,0\n"), 11, 3, "420 nm");
    refused(head + changed(body, "1,410,0.001,0\n", "1,410,0.001\n"), 11, 7, "3 cells");
    refused(head + changed(body, "1,410,0.001,0\n", "1,410,x,0\n"), 11, 7, "x");
    refused(head + changed(body, "matrix,410,0.01", "matrix,410,nan"), 7, 12, "missing");
    refused(head + changed(changed(body, "1,400", "2,400"), "1,410", "2,410"), 10, 1, "part '2'");
    refused(head + body + body.substr(body.find("independent"), 48), 12, 1, "no place here");
    refused(changed(head, "directions: 1", "directions: 2") + body, 11, 1, "promises 2");
    refused(changed(head, "# directions: 1\n", "") + body, 10, 1, "# directions: 1");
    refused(changed(head, "rows-emission", "rows-excitation") + body, 3, 16, "rows-emission");
    refused(changed(head, "per-band", "density-per-nm") + body, 2, 13, "per-band");
    refused(head + "part,nm,400,410\n", 5, 1, "no part 'independent'");
}

TEST(MatrixCovariance, FewerDirectionsLeaveTheStandardErrors) {
    MatrixCovariance covariance = three_directions();
    Eigen::MatrixXd many(12, 6); // three directions, each split in two, and 1e-6 of one
    for (Eigen::Index k = 0; k < 3; ++k) {
        many.col(2 * k) = 0.6 * covariance.directions.col(k);
        many.col(2 * k + 1) = 0.8 * covariance.directions.col(k);
    }
    many(0, 5) += 1e-7;
    const Eigen::MatrixXd full = many * many.transpose();
    covariance.directions = many;
    const MatrixCovariance fewer = in_fewer_directions(covariance);
    EXPECT_EQ(fewer.directions.cols(), 3);
    EXPECT_LT((fewer.standard_errors() - covariance.standard_errors()).cwiseAbs().maxCoeff(),
              1e-12);
    EXPECT_LT((fewer.directions * fewer.directions.transpose() - full).cwiseAbs().maxCoeff(),
              1e-10);
}
