#include "tests/film/film_fixtures.h"

#include <chrono>
#include <random>

namespace reradiant {

namespace {

/// Reads the bytes as an image: success or an input Error that names the file, nothing else.
/// Returns whether it was read.
bool reads(const std::filesystem::path& file, const std::string& bytes) {
    put_bytes(file, bytes);
    try {
        read_spectral_exr(file);
        return true;
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2) << error.what();
        EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
        return false;
    }
}

SpectralImage small_image() {
    SpectralImage image = patterned_image(3, 20, grid_from_range(380, 480, 50));
    image.sample_count.assign(60, 4.0f);
    return image;
}

} // namespace

TEST(DamagedExr, Case52FileCutAtSixtyPercentIsRefused) {
    const TemporaryFolder folder;
    write_spectral_exr(folder / "a.exr", patterned_image(64, 256, grid_from_range(380, 780, 10)));
    const std::string whole = file_bytes(folder / "a.exr");
    ASSERT_TRUE(reads(folder / "b.exr", whole));
    EXPECT_FALSE(reads(folder / "b.exr", whole.substr(0, whole.size() * 6 / 10)));
}

TEST(DamagedExr, Case36TruncationAtEveryByteIsRefused) {
    const TemporaryFolder folder;
    write_spectral_exr(folder / "a.exr", small_image());
    const std::string whole = file_bytes(folder / "a.exr");
    for (std::size_t length = 0; length < whole.size(); ++length)
        ASSERT_FALSE(reads(folder / "b.exr", whole.substr(0, length))) << length << " bytes";
}

TEST(DamagedExr, FlippedBytesAreReadOrRefusedButNeverCrash) {
    const TemporaryFolder folder;
    write_spectral_exr(folder / "a.exr", small_image());
    const std::string whole = file_bytes(folder / "a.exr");
    std::mt19937 random(20240611);
    for (int trial = 0; trial < 2000; ++trial) {
        std::string bytes = whole;
        // Half of the trials hit the headers, where sizes and counts lie.
        const std::size_t range = trial % 2 == 0 ? bytes.size() : 1500;
        bytes[random() % range] = static_cast<char>(random() % 256);
        reads(folder / "b.exr", bytes);
    }
}

TEST(DamagedExr, Case36HeaderThatPromisesATerabyteIsRefusedAtOnce) {
    const TemporaryFolder folder;
    write_spectral_exr(folder / "a.exr", small_image());
    std::string bytes = file_bytes(folder / "a.exr");
    const std::size_t window = bytes.find("dataWindow");
    ASSERT_NE(window, std::string::npos);
    // name, 0, "box2i", 0, size, then xMin yMin xMax yMax
    const std::size_t maximum = window + sizeof("dataWindow") + sizeof("box2i") + 4 + 8;
    const std::string side("\xff\xff\x00\x00", 4); // 65535
    bytes.replace(maximum, 8, side + side);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(reads(folder / "b.exr", bytes));
    // The limit of the case; a read of 65536 rows takes minutes.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

TEST(DamagedExr, MissingEmptyAndForeignFilesAreRefusedByName) {
    const TemporaryFolder folder;
    EXPECT_NE(error_message(2, [&] { read_spectral_exr(folder / "no.exr"); }).find("no.exr"),
              std::string::npos);
    error_message(2, [&] { read_spectral_exr(folder / ""); });
    EXPECT_FALSE(reads(folder / "empty.exr", ""));
    EXPECT_FALSE(reads(folder / "text.exr", "[film]\nwidth = 4\n"));
}

} // namespace reradiant
