#include "reradiant/error.h"
#include "reradiant/spectral_files.h"
#include "tests/support/scratch_folder.h"

#include <chrono>
#include <random>

using namespace reradiant;

namespace {

class HostileFiles : public test::ScratchFolder {
protected:
    void SetUp() override {
        test::ScratchFolder::SetUp();
        matrix_ = {{400, 10, 3}, {390, 10, 4}, Eigen::MatrixXd::Zero(3, 4)};
        matrix_.values << 0.01, 0.3, 0, 0, 0, 0.1, 0.7, 0, 0.04, 0.05, 0.06, 0.4;
    }

    /// An input Error or a matrix that is whole; anything else fails the test or ends it.
    void read_somehow(const std::string& name, const std::string& bytes) const {
        try {
            const ReradiationMatrix matrix = read_reradiation(write(name, bytes));
            EXPECT_TRUE(matrix.values.allFinite());
            EXPECT_EQ(matrix.values.rows(), matrix.emission.count);
            EXPECT_EQ(matrix.values.cols(), matrix.excitation.count);
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2) << error.what();
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
        }
    }

    ReradiationMatrix matrix_;
};

} // namespace

TEST_F(HostileFiles, Case36TruncationAtEveryByteIsAnErrorOrAWholeMatrix) {
    for (const char* name : {"m.csv", "m.bfc", "m.exr"}) {
        write_reradiation(path(name), matrix_);
        const std::string whole = test::file_bytes(path(name));
        for (std::size_t size = 0; size < whole.size(); ++size)
            read_somehow(name, whole.substr(0, size));
    }
}

TEST_F(HostileFiles, Case36BfcCutBeforeItsEndIsRefused) {
    write_reradiation(path("m.bfc"), matrix_);
    const std::string whole = test::file_bytes(path("m.bfc"));
    // Every length up to the line end after EOD is refused; only the line end itself may be
    // missing.
    for (std::size_t size = 0; size < whole.size() - 2; ++size)
        EXPECT_THROW(read_reradiation(write("m.bfc", whole.substr(0, size))), Error) << size;
}

TEST_F(HostileFiles, FlippedBytesAreAnErrorOrAWholeMatrix) {
    std::mt19937 generator(11);
    for (const char* name : {"m.csv", "m.bfc", "m.exr"}) {
        write_reradiation(path(name), matrix_);
        const std::string whole = test::file_bytes(path(name));
        for (int trial = 0; trial < 300; ++trial) {
            std::string bytes = whole;
            for (int flips = 0; flips < 3; ++flips)
                bytes[generator() % bytes.size()] = static_cast<char>(generator() % 256);
            read_somehow(name, bytes);
        }
    }
}

TEST_F(HostileFiles, Case36AbsurdCountsAreRefusedAtOnce) {
    const auto start = std::chrono::steady_clock::now();
    const std::string head = "VEC_01\t5167\r\nBFC-450 Matrix File\r\n";
    for (const char* ranges :
         {"380\t780\t10\t-1\t300\t10", "380\t780\t10\t9223372036854775808\t300\t10",
          "380\t780\t1e-9\t49\t300\t10", "380\t780\t10\t999999\t300\t10",
          "380\t780\t10\t0\t300\t10", "380\t780\t10\t49.5\t300\t10", "780\t380\t10\t49\t300\t10",
          "380\t780\t0\t49\t300\t10", "380\t780\t10\tnan\t300\t10", "380\t780\t10\t49\t300",
          "1\t90000\t1\t90000\t1\t1"})
        EXPECT_THROW(read_reradiation(write("m.bfc", head + ranges + "\r\nr:c:\t300\r\n")), Error)
            << ranges;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 1.0);
}

TEST_F(HostileFiles, Case36LongLinesAndManyRowsAreRefusedQuickly) {
    std::string wide = "# quantity: per-band\n# orientation: rows-emission\nnm";
    for (int k = 1; k <= 100001; ++k)
        wide.append(",").append(std::to_string(k));
    const auto start = std::chrono::steady_clock::now();
    EXPECT_THROW(read_reradiation(write("w.csv", wide + "\n")), Error);
    EXPECT_THROW(read_reradiation(write("c.csv", std::string(1000000, ','))), Error);
    EXPECT_THROW(read_reradiation(write("n.csv", std::string(1000000, '\n'))), Error);
    EXPECT_THROW(read_reradiation(write("z.csv", std::string(1000000, '\0'))), Error);
    EXPECT_THROW(read_reradiation(write("h.csv", std::string(1000000, '#'))), Error);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 1.0);
}

TEST_F(HostileFiles, Case36HugeFilesAreRefusedUnread) {
    // A sparse file: a hole of 2^40 bytes takes no room.
    write("big.csv", "");
    std::filesystem::resize_file(path("big.csv"), std::uintmax_t{1} << 40);
    EXPECT_THROW(read_reradiation(path("big.csv")), Error);
    EXPECT_THROW(read_spectrum(path("big.csv")), Error);
}

TEST_F(HostileFiles, ImageOfManyPixelsIsNoMatrix) {
    // A 1 x 1 image's data window is 16 bytes; widen it without the pixels.
    write_reradiation(path("m.exr"), matrix_);
    std::string bytes = test::file_bytes(path("m.exr"));
    const auto at = bytes.find("dataWindow");
    ASSERT_NE(at, std::string::npos);
    const auto corner = at + std::string("dataWindow").size() + 1 + std::string("box2i").size() +
                        1 + 4 + 8; // name, type, size, lower corner
    bytes[corner] = '\x7f';
    bytes[corner + 1] = '\x7f';
    EXPECT_THROW(read_reradiation(write("m.exr", bytes)), Error);
}

TEST_F(HostileFiles, SpectraSurviveTruncationAndNoise) {
    write_spectrum(path("s.csv"), {400, 410, 420}, {0.1, 0.25, 1.5e-3});
    const std::string whole = test::file_bytes(path("s.csv"));
    std::mt19937 generator(13);
    for (int trial = 0; trial < 600; ++trial) {
        std::string bytes = whole.substr(0, generator() % (whole.size() + 1));
        if (!bytes.empty())
            bytes[generator() % bytes.size()] = static_cast<char>(generator() % 256);
        try {
            read_spectrum(write("s.csv", bytes));
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2);
        }
    }
}
