#include "reradiant/error.h"
#include "reradiant/spectral_files.h"
#include "tests/spectral/refusal.h"
#include "tests/support/scratch_folder.h"

#include <clocale>
#include <cmath>
#include <limits>

using namespace reradiant;

namespace {

ReradiationMatrix sample() {
    ReradiationMatrix matrix{{400, 10, 3}, {390, 10, 4}, Eigen::MatrixXd::Zero(3, 4)};
    matrix.values << 0.01, 1.0 / 3.0, 0, 0, 1e-17, 0.1, 0.7, 0, 0.04, 0.05, 0.06, 0.4;
    matrix.geometry = "45/0";
    return matrix;
}

/// Unequal steps, one anti-Stokes entry with leave.
ReradiationMatrix uneven() {
    ReradiationMatrix matrix{{400, 5, 5}, {390, 10, 3}, Eigen::MatrixXd::Zero(5, 3)};
    for (int k = 0; k < 15; ++k)
        matrix.values.data()[k] = 0.9 * std::sin(k + 1.0) * std::sin(k + 1.0);
    matrix.anti_stokes_allowed = true;
    matrix.kind = MatrixKind::Measured;
    return matrix;
}

void expect_same(const ReradiationMatrix& a, const ReradiationMatrix& b, double tolerance) {
    EXPECT_EQ(a.emission, b.emission);
    EXPECT_EQ(a.excitation, b.excitation);
    ASSERT_EQ(a.values.rows(), b.values.rows());
    ASSERT_EQ(a.values.cols(), b.values.cols());
    EXPECT_LE((a.values - b.values).cwiseAbs().maxCoeff(), tolerance);
}

class MatrixIo : public test::ScratchFolder {
protected:
    SourcePosition place_of_refusal(const std::string& name, const std::string& text) const {
        try {
            read_reradiation(write(name, text));
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2) << error.what();
            return error.position();
        }
        ADD_FAILURE() << "accepted: " << text;
        return {};
    }
    static std::filesystem::path input(const std::string& name) {
        return std::filesystem::path(RERADIANT_SOURCE_DIR) / "tests" / "spectral" / "inputs" / name;
    }
    const std::string head = "# quantity: per-band\n# orientation: rows-emission\n";
};

} // namespace

TEST_F(MatrixIo, CsvReadsBackTheSameDoubles) {
    for (const MatrixCsvForm& form : {MatrixCsvForm{}, {MatrixQuantity::PerBand, false}}) {
        write_reradiation_csv(path("m.csv"), sample(), form);
        const ReradiationMatrix read = read_reradiation(path("m.csv"));
        expect_same(read, sample(), 0.0);
        EXPECT_EQ(read.geometry, "45/0");
        EXPECT_EQ(read.kind, MatrixKind::Model);
        EXPECT_FALSE(read.anti_stokes_allowed);
    }
}

TEST_F(MatrixIo, CsvDensityScalesAllButTheDiagonal) {
    write_reradiation_csv(path("m.csv"), sample(), {MatrixQuantity::DensityPerNm, true});
    // Two roundings, of the division and of the product.
    expect_same(read_reradiation(path("m.csv")), sample(), 1e-16);
    const ReradiationMatrix density =
        read_reradiation(write("d.csv", "# quantity: density-per-nm\n# orientation: rows-emission\n"
                                        "nm,400,420\n400,0.5,0\n410,0.01,0\n420,0.02,0.6\n"));
    EXPECT_EQ(density.values(0, 0), 0.5);
    EXPECT_NEAR(density.values(1, 0), 0.2, 1e-16);
    EXPECT_NEAR(density.values(2, 0), 0.4, 1e-16);
    EXPECT_EQ(density.values(2, 1), 0.6);
}

TEST_F(MatrixIo, CsvKeepsKindAndLeave) {
    write_reradiation(path("m.csv"), uneven());
    const ReradiationMatrix read = read_reradiation(path("m.csv"));
    expect_same(read, uneven(), 0.0);
    EXPECT_EQ(read.kind, MatrixKind::Measured);
    EXPECT_TRUE(read.anti_stokes_allowed);
}

TEST_F(MatrixIo, CsvLongFormMayLeaveOutImpossibleEntries) {
    const ReradiationMatrix matrix =
        read_reradiation(write("m.csv", head + "excitation_nm,emission_nm,value\n"
                                               "410,410,0.4\n400,410,0.2\n400,400,0.3\n"));
    EXPECT_EQ(matrix.emission, (WavelengthGrid{400, 10, 2}));
    EXPECT_EQ(matrix.values(0, 0), 0.3);
    EXPECT_EQ(matrix.values(1, 0), 0.2);
    EXPECT_EQ(matrix.values(0, 1), 0.0);
    EXPECT_EQ(place_of_refusal("gap.csv", head + "excitation_nm,emission_nm,value\n"
                                                 "400,400,0.3\n410,410,0.4\n")
                  .line,
              5);
    EXPECT_EQ(place_of_refusal("twice.csv", head + "excitation_nm,emission_nm,value\n"
                                                   "400,400,0.3\n400,400,0.3\n")
                  .line,
              5);
}

TEST_F(MatrixIo, CsvNeverGuessesQuantityOrOrientation) {
    place_of_refusal("q.csv", "# orientation: rows-emission\nnm,400\n400,0.5\n");
    place_of_refusal("o.csv", "# quantity: per-band\nnm,400\n400,0.5\n");
    const SourcePosition place =
        place_of_refusal("w.csv", "# quantity: per-bend\n# orientation: rows-emission\nnm,400\n");
    EXPECT_EQ(place.line, 1);
    EXPECT_EQ(place.column, 13);
    place_of_refusal("t.csv", "# quantity: per-band\n" + head + "nm,400\n400,0.5\n");
}

TEST_F(MatrixIo, CsvErrorsNameLineAndColumn) {
    const auto place = [&](const std::string& body) {
        const SourcePosition at = place_of_refusal("e.csv", head + body);
        return std::pair{at.line, at.column};
    };
    EXPECT_EQ(place("nm,400,410\n400,0.1,oops\n"), (std::pair{4, 9}));
    EXPECT_EQ(place("nm,400,410\n400,0.1,nan\n"), (std::pair{4, 9}));
    EXPECT_EQ(place("nm,400,410\n400,0.1,1e38\n"), (std::pair{4, 9}));
    EXPECT_EQ(place("nm,400,410\n400,0.1,1e999\n"), (std::pair{4, 9}));
    EXPECT_EQ(place("nm,400,410\n400,0.1,\n").first, 4);
    EXPECT_EQ(place("nm,400,410\n400,0.1\n").first, 4);
    EXPECT_EQ(place("nm,400,410\n400,0.1,0.2,0.3\n").first, 4);
    EXPECT_EQ(place("nm,400,400\n400,0.1,0.2\n"), (std::pair{3, 8}));
    EXPECT_EQ(place("nm,400,410,425\n400,0.1,0,0\n"), (std::pair{3, 12}));
    EXPECT_EQ(place("nm,400,410\n410,0.1,0.2\n410,0.1,0.2\n"), (std::pair{5, 1}));
    EXPECT_EQ(place("nm,400,-410\n400,0.1,0.2\n"), (std::pair{3, 8}));
    EXPECT_EQ(place("nm,400,410\n").first, 3);
    EXPECT_EQ(place("nm\n400\n").first, 3);
    EXPECT_EQ(place("reflectance,400\n400,1\n").first, 3);
    place_of_refusal("empty.csv", "");
    place_of_refusal("comments.csv", head);
}

TEST_F(MatrixIo, AxesInAnyOrderAreSorted) {
    const ReradiationMatrix wide = read_reradiation(
        write("w.csv", head + "nm,420,400,410\n410,0,0.2,0.5\n420,0.6,0.1,0.3\n400,0,0.4,0\n"));
    const ReradiationMatrix sorted = read_reradiation(
        write("s.csv", head + "nm,400,410,420\n400,0.4,0,0\n410,0.2,0.5,0\n420,0.1,0.3,0.6\n"));
    expect_same(wide, sorted, 0.0);
    const ReradiationMatrix other = read_reradiation(
        write("o.csv", "# quantity: per-band\n# orientation: rows-excitation\n"
                       "nm,420,400,410\n410,0.3,0,0.5\n420,0.6,0,0\n400,0.1,0.4,0.2\n"));
    expect_same(other, sorted, 0.0);
    EXPECT_EQ(read_reradiation(input("descending-em.csv")).emission, (WavelengthGrid{380, 20, 7}));
    EXPECT_EQ(read_reradiation(input("descending-em.csv")).values(0, 4), 0.3);
}

TEST_F(MatrixIo, RoundedAxesKeepTheirDiagonal) {
    const ReradiationMatrix matrix = read_reradiation(input("rounded-em.csv"));
    EXPECT_EQ(matrix.emission, (WavelengthGrid{380, 10.0 / 3.0, 12}));
    EXPECT_EQ(diagonal_row(matrix, 4), 0);
    EXPECT_EQ(diagonal_row(matrix, 5), 6);
    // Without its first row the ends are rounded as well; 390 nm stays on the diagonal.
    const ReradiationMatrix cut = read_reradiation(
        write("c.csv", head + "nm,380,390\n383.33,0.1,0\n386.67,0.1,0\n390,0.1,0.4\n"
                              "393.33,0.1,0.2\n"));
    EXPECT_EQ(diagonal_row(cut, 1), 2);
    // numpy writes the sign of every exponent.
    const ReradiationMatrix exponents =
        read_reradiation(write("e.csv", head + "nm,3.83333e+02,3.86667e+02,3.90000e+02\n"
                                               "3.83333e+02,0.1,0,0\n3.86667e+02,0.1,0.2,0\n"
                                               "3.90000e+02,0.1,0.1,0.3\n"));
    EXPECT_NEAR(exponents.excitation.step_nm, 10.0 / 3.0, 1e-5);
    EXPECT_EQ(diagonal_row(exponents, 2), 2);
    EXPECT_EQ(place_of_refusal("u.csv", head + "nm,380\n380.00,0.1\n383.33,0.1\n386.60,0.1\n"
                                               "390.00,0.1\n")
                  .line,
              6);
}

TEST_F(MatrixIo, GapsAreRefusedWhereEveryEntryCounts) {
    for (const char* name : {"gap-NA.csv", "gap-blank.csv", "gap-masked.csv"}) {
        EXPECT_EQ(refusal([&] { read_reradiation(input(name)); }, "missing"), (std::pair{6, 41}))
            << name;
        const ReradiationMatrix gaps = read_reradiation(input(name), Gaps::BecomeNan);
        EXPECT_TRUE(std::isnan(gaps.values(0, 4)) && std::isnan(gaps.values(1, 5))) << name;
        EXPECT_EQ(gaps.values(1, 4), 0.001642) << name;
        EXPECT_EQ(gaps.values.array().isNaN().count(), 3) << name;
    }
}

TEST_F(MatrixIo, UnitsAreReadOrRefused) {
    EXPECT_EQ(refusal([&] { read_reradiation(input("percent.csv")); }, "percent"),
              (std::pair{6, 5}));
    const ReradiationMatrix percent = read_reradiation(
        write("p.csv", "# unit: percent\n" + head + "nm,400,410\n400,30,0\n410,20,40\n"));
    EXPECT_EQ(percent.values(0, 0), 0.3);
    EXPECT_EQ(percent.values(1, 0), 0.2);
    // A dark sample in percent has no entry above 10.
    place_of_refusal("d.csv", head + "nm,400,410,420\n400,4,0,0\n410,1,5,0\n420,1,1,6\n");
    place_of_refusal("n.csv", "# units: counts\n" + head + "nm,400\n400,0.3\n");
    // One total radiance factor of 2.4 is legal, and so is an outlier.
    EXPECT_EQ(read_reradiation(write("l.csv", "# kind: measured\n" + head +
                                                  "nm,400,410,420\n400,2.4,0,0\n410,0,0.5,0\n"
                                                  "420,0,0,0.5\n"))
                  .values(0, 0),
              2.4);
    EXPECT_EQ(read_reradiation(write("u.csv", head + "um,0.4,0.41\n0.4,0.3,0\n0.41,0.2,0.4\n"))
                  .emission.count,
              2);
    place_of_refusal("b.csv", head + "nm,0.4,0.41\n0.4,0.3,0\n0.41,0.2,0.4\n");
    place_of_refusal("k.csv", head + "cm-1,20000,25000\n20000,0.3,0\n25000,0.2,0.4\n");
}

TEST_F(MatrixIo, CsvOfSpreadsheetsIsRead) {
    const ReradiationMatrix plain =
        read_reradiation(write("p.csv", head + "nm,400,410\n400,0.3,0\n410,0.2,0.4\n"));
    for (const char* body : {"nm;400;410\r\n400;0.3;0\r\n410;0.2;0.4\r\n",
                             "\"nm\",\"400\",\"410\"\r\"400\",\"0.3\",\"0\"\r410,0.2,0.4\r\x1a",
                             "nm,400,410,,\n400,0.3,0,,\n410,0.2,0.4,,\n,,,,\n",
                             "nm\t400\t410\n400\t0.3\t0\n\f\n410\t0.2\t0.4\n",
                             "Wavelength (nm),400nm,410nm\n400nm,0.3,0\n410nm,0.2,0.4\n"})
        expect_same(read_reradiation(write("s.csv", head + body)), plain, 0.0);
    expect_same(read_reradiation(write("c.csv", head + "nm;400;410\n400;0,3;0\n410;0,2;0,4\n")),
                plain, 0.0);
}

TEST_F(MatrixIo, Case26AntiStokesModelIsRefusedUnlessDeclared) {
    const std::string body = "nm,400,410\n400,0.1,0.2\n410,0.1,0.2\n";
    EXPECT_EQ(place_of_refusal("m.csv", head + body).line, 3);
    EXPECT_TRUE(read_reradiation(write("a.csv", "# anti-stokes: allowed\n" + head + body))
                    .anti_stokes_allowed);
    EXPECT_EQ(read_reradiation(write("k.csv", "# kind: measured\n" + head + body)).values(0, 1),
              0.2);
}

TEST_F(MatrixIo, Case68CsvTakesCrLfBlanksAndByteOrderMark) {
    const ReradiationMatrix matrix = read_reradiation(write(
        "m.csv", "\xef\xbb\xbf# reradiation\r\n# quantity: per-band\r\n"
                 "# orientation: rows-excitation\r\n\r\nnm, 400 ,410\r\n 400,+0.1, 2e-1\r\n"));
    EXPECT_EQ(matrix.values(1, 0), 0.2);
    EXPECT_EQ(matrix.excitation.count, 1);
    EXPECT_EQ(matrix.excitation.step_nm, 10.0);
}

TEST_F(MatrixIo, OneBandKeepsItsWidth) {
    ReradiationMatrix matrix{{500, 20, 1}, {400, 7, 1}, Eigen::MatrixXd::Constant(1, 1, 0.3)};
    for (const char* name : {"m.csv", "m.exr"}) {
        write_reradiation(path(name), matrix);
        // EXR keeps single precision: half an ULP of 0.3.
        expect_same(read_reradiation(path(name)), matrix, 1.5e-8);
    }
}

TEST_F(MatrixIo, BfcReadsBackTheSameDoubles) {
    write_reradiation(path("m.bfc"), sample());
    const ReradiationMatrix read = read_reradiation(path("m.bfc"));
    expect_same(read, sample(), 0.0);
    EXPECT_EQ(read.kind, MatrixKind::Measured);
}

TEST_F(MatrixIo, BfcWeightsAreConvertedFromEmissionToExcitationSteps) {
    const ReradiationMatrix matrix = read_reradiation(write(
        "m.bfc", "VEC_01\t5167\r\nBFC-450 Matrix File\r\n;note\r\n400\t410\t5\t2\t400\t10\r\n"
                 "r:c:\t400\t410\t\r\n400\t0.5\t0\t\r\n405\t0.1\t0\r\n410\t0.2\t0.6\r\nEOD\r\n"));
    EXPECT_EQ(matrix.values(0, 0), 0.5);
    EXPECT_NEAR(matrix.values(1, 0), 0.2, 1e-16);
    EXPECT_NEAR(matrix.values(2, 0), 0.4, 1e-16);
    EXPECT_EQ(matrix.values(2, 1), 0.6);
    write_reradiation(path("w.bfc"), matrix);
    expect_same(read_reradiation(path("w.bfc")), matrix, 1e-16);
}

TEST_F(MatrixIo, ExrReadsBackInSinglePrecision) {
    for (const ReradiationMatrix& matrix : {sample(), uneven()}) {
        write_reradiation(path("m.exr"), matrix);
        const ReradiationMatrix read = read_reradiation(path("m.exr"));
        expect_same(read, matrix, 6e-8); // half an ULP of a float below 1
        EXPECT_EQ(read.kind, matrix.kind);
        EXPECT_EQ(read.anti_stokes_allowed, matrix.anti_stokes_allowed);
        EXPECT_EQ(read.geometry, matrix.geometry);
    }
}

TEST_F(MatrixIo, ExrKeepsFractionalGridsExactly) {
    ReradiationMatrix matrix{
        {400, 10.0 / 3.0, 4}, {400, 10.0 / 3.0, 4}, Eigen::MatrixXd::Identity(4, 4)};
    write_reradiation(path("m.exr"), matrix);
    expect_same(read_reradiation(path("m.exr")), matrix, 0.0);
}

TEST_F(MatrixIo, Case35NumbersDoNotDependOnTheLocale) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    // On a machine that lacks this locale the test still checks the C locale.
    const bool comma = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    RecordProperty("decimal_comma_locale", comma ? "yes" : "no");
    for (const char* name : {"m.csv", "m.bfc", "m.exr"}) {
        write_reradiation(path(name), sample());
        EXPECT_NEAR(read_reradiation(path(name)).values(2, 3), 0.4, 1e-7) << name;
    }
    const std::string exr = test::file_bytes(path("m.exr"));
    EXPECT_NE(exr.find("T.390,000000nm.400,000000nm"), std::string::npos);
    EXPECT_NE(exr.find("T.400,000000nm"), std::string::npos);
    std::setlocale(LC_ALL, before.c_str());
}

TEST_F(MatrixIo, EndingsAreKnownInAnyCaseAndOthersRefused) {
    write_reradiation(path("m.bfc"), sample());
    std::filesystem::rename(path("m.bfc"), path("m.BFC"));
    EXPECT_EQ(read_reradiation(path("m.BFC")).values(0, 0), 0.01);
    EXPECT_THROW(read_reradiation(path("m.txt")), Error);
    EXPECT_THROW(write_reradiation(path("m.txt"), sample()), Error);
    EXPECT_THROW(read_reradiation(path("missing.csv")), Error);
    EXPECT_THROW(read_reradiation(path("missing.exr")), Error);
    EXPECT_THROW(read_reradiation(folder), Error);
}

TEST_F(MatrixIo, Case53FailedWriteIsAnErrorAndLeavesNothing) {
    for (const char* name : {"absent/m.csv", "absent/m.bfc", "absent/m.exr"})
        EXPECT_THROW(write_reradiation(path(name), sample()), Error) << name;
    EXPECT_THROW(write_spectrum(path("absent/s.csv"), {400, 500}, {1, 2}), Error);
    EXPECT_EQ(scratch.file_count(), 0u);
}

TEST_F(MatrixIo, SpectraReadBackTheSameDoubles) {
    for (const char* name : {"s.csv", "s.spd"}) {
        write_spectrum(path(name), {400.1, 500, 600}, {1.0 / 3.0, 1e-17, -2.5});
        const Spectrum spectrum = read_spectrum(path(name));
        EXPECT_EQ(spectrum(400.1), 1.0 / 3.0) << name;
        EXPECT_EQ(spectrum(500), 1e-17) << name;
        EXPECT_EQ(spectrum(600), -2.5) << name;
    }
    EXPECT_THROW(write_spectrum(path("s.txt"), {400, 500}, {1, 2}), Error);
    EXPECT_THROW(write_spectrum(path("s.csv"), {500, 400}, {1, 2}), std::invalid_argument);
}

TEST_F(MatrixIo, SpectrumFilesTakeCommentsHeadingsAndBlanks) {
    EXPECT_EQ(read_spectrum(write("a.csv", "# c\nnm,value\n400,0.5\n500,1\n"))(450), 0.75);
    EXPECT_EQ(read_spectrum(write("b.spd", "400 0.5\r\n\r\n  500\t1\r\n"))(450), 0.75);
    EXPECT_EQ(read_spectrum(write("c.spd", "550 0.5"))(300), 0.5);
}

TEST_F(MatrixIo, Case35SpectrumErrorsNameLineAndColumn) {
    const auto place = [&](const std::string& text) {
        try {
            read_spectrum(write("s.csv", text));
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2);
            return std::pair{error.position().line, error.position().column};
        }
        ADD_FAILURE() << "accepted: " << text;
        return std::pair{0, 0};
    };
    EXPECT_EQ(place("400,1\n400,2\n"), (std::pair{2, 1}));
    EXPECT_EQ(place("400,1\n500,nan\n"), (std::pair{2, 5}));
    EXPECT_EQ(place("400,1\n500,1e38\n"), (std::pair{2, 5}));
    EXPECT_EQ(place("400,1\n500\n"), (std::pair{2, 1}));
    EXPECT_EQ(place("400,1\n500,1,2\n"), (std::pair{2, 1}));
    EXPECT_EQ(place("400,1\nabc,2\n"), (std::pair{2, 1}));
    EXPECT_EQ(place("-400,1\n"), (std::pair{1, 1}));
    EXPECT_EQ(place("").first, 1);
    EXPECT_EQ(place("# nothing\n").first, 1);
}

TEST_F(MatrixIo, MatricesAndSpectraAreToldApart) {
    write_reradiation(path("m.csv"), sample());
    EXPECT_TRUE(holds_reradiation(path("m.csv")));
    EXPECT_FALSE(holds_reradiation(write("s.csv", "# spectrum\nnm,value\n400,1\n")));
    EXPECT_TRUE(holds_reradiation(write("l.csv", head + "excitation_nm,emission_nm,value\n")));
    EXPECT_FALSE(holds_reradiation(write("s.spd", "400 1\n")));
    EXPECT_THROW(holds_reradiation(path("missing.csv")), Error);
}
