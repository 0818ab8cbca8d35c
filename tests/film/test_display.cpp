#include "reradiant/colour.h"
#include "tests/film/film_fixtures.h"

#include <png.h>

#include <cstdlib>

namespace reradiant {

namespace {

/// Every band has the mean of the spectrum over its cell.
SpectralImage image_of(const Spectrum& spectrum, const WavelengthGrid& bands) {
    SpectralImage image = flat_image(2, 2, bands, 0.0f);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
            for (int band = 0; band < bands.count; ++band)
                image.at(x, y, band) = static_cast<float>(
                    spectrum.average(bands.lower_edge_nm(band), bands.upper_edge_nm(band)));
    return image;
}

/// Codes of the first pixel of a PNG of 2 x 2 pixels.
std::array<int, 3> first_pixel(const std::filesystem::path& file) {
    png_image picture{};
    picture.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&picture, file.c_str()), 0) << picture.message;
    EXPECT_EQ(picture.width, 2u);
    EXPECT_EQ(picture.height, 2u);
    picture.format = PNG_FORMAT_RGB;
    png_byte codes[12] = {};
    EXPECT_NE(png_image_finish_read(&picture, nullptr, codes, 0, nullptr), 0) << picture.message;
    return {codes[0], codes[1], codes[2]};
}

double srgb_code(double linear) {
    return 255.0 *
           (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055);
}

const WavelengthGrid visible = grid_from_range(380, 780, 5);

class Display : public ::testing::Test {
protected:
    void SetUp() override { ::unsetenv("OCIO"); }
    const TemporaryFolder folder;
};

/// A configuration of OpenColorIO with the given roles and one display "Screen", view "Raw",
/// which shows the scene_linear space's values as they are.
std::string configuration(const std::string& roles) {
    return "ocio_profile_version: 2\n"
           "roles:\n  default: linear\n" +
           roles +
           "displays:\n  Screen:\n    - !<View> {name: Raw, colorspace: linear}\n"
           "active_displays: []\nactive_views: []\n"
           "colorspaces:\n  - !<ColorSpace>\n    name: linear\n    isdata: false\n"
           "  - !<ColorSpace>\n    name: aces\n    isdata: false\n"
           "    to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, "
           "0, 0, 0, 0, 1]}\n";
}

} // namespace

TEST_F(Display, D65OnWhiteIsNeutral) {
    const SpectralImage image = image_of(illuminant_with_luminance("D65", 0.5), visible);
    EXPECT_EQ(write_display_png(folder / "a.png", image, {}), 0u);
    // One code: rounding, and the white of sRGB is given to four digits of xy.
    for (const int code : first_pixel(folder / "a.png"))
        EXPECT_NEAR(code, srgb_code(0.5), 1.0);
}

TEST_F(Display, ExposureDoublesTheLight) {
    const SpectralImage image = image_of(illuminant_with_luminance("D65", 0.125), visible);
    DisplayOptions options;
    options.exposure_ev = 2.0;
    write_display_png(folder / "a.png", image, options);
    for (const int code : first_pixel(folder / "a.png"))
        EXPECT_NEAR(code, srgb_code(0.5), 1.0);
}

TEST_F(Display, PixelsOutOfGamutAreClippedAndCounted) {
    // A laser's green has negative red in sRGB; twice the white is too bright; NaN is neither.
    EXPECT_EQ(write_display_png(folder / "green.png",
                                image_of(Spectrum::gaussian(520, 5, 1), visible), {}),
              4u);
    EXPECT_EQ(first_pixel(folder / "green.png")[0], 0);
    SpectralImage image = image_of(illuminant_with_luminance("D65", 0.5), visible);
    for (int band = 0; band < visible.count; ++band)
        image.at(0, 0, band) *= 4.0f;
    image.at(1, 1, 3) = std::nanf("");
    EXPECT_EQ(write_display_png(folder / "a.png", image, {}), 2u);
    EXPECT_EQ(first_pixel(folder / "a.png"), (std::array<int, 3>{255, 255, 255}));
}

TEST_F(Display, UnknownDisplayAndViewListWhatThereIs) {
    const SpectralImage image = flat_image(2, 2, visible, 0.5f);
    DisplayOptions options;
    options.display = "Cinema";
    const std::string message =
        error_message(2, [&] { write_display_png(folder / "a.png", image, options); });
    EXPECT_NE(message.find("sRGB"), std::string::npos) << message;
    options = {};
    options.view = "Filmic";
    error_message(2, [&] { write_display_png(folder / "a.png", image, options); });
    EXPECT_EQ(folder.file_count(), 0u);
}

TEST_F(Display, ConfigurationWithTheSceneInterchangeRoleIsUsed) {
    put_bytes(folder / "config.ocio", configuration("  scene_linear: linear\n"
                                                    "  aces_interchange: aces\n"));
    const SpectralImage image = image_of(illuminant_with_luminance("D65", 0.25), visible);
    DisplayOptions options;
    options.ocio_config = folder / "config.ocio";
    write_display_png(folder / "a.png", image, options);
    // White of XYZ (Y = 0.25) is neutral 0.25 in ACES, which this configuration doubles.
    for (const int code : first_pixel(folder / "a.png"))
        EXPECT_NEAR(code, 127.5, 1.0);
}

TEST_F(Display, OptionBeatsEnvironmentBeatsBuiltIn) {
    put_bytes(folder / "config.ocio", configuration("  scene_linear: linear\n"));
    const SpectralImage image = image_of(illuminant_with_luminance("D65", 0.25), visible);
    ::setenv("OCIO", (folder / "config.ocio").c_str(), 1);
    write_display_png(folder / "a.png", image, {});
    // The configuration's view shows linear values, sRGB would give code 137.
    for (const int code : first_pixel(folder / "a.png"))
        EXPECT_NEAR(code, 63.75, 1.0);
    DisplayOptions options;
    options.ocio_config = folder / "missing.ocio";
    const std::string message =
        error_message(2, [&] { write_display_png(folder / "b.png", image, options); });
    EXPECT_NE(message.find("missing.ocio"), std::string::npos) << message;
    EXPECT_FALSE(std::filesystem::exists(folder / "b.png"));
    ::unsetenv("OCIO");
}

TEST_F(Display, Case53FullDiskGivesARunTimeError) {
    const SpectralImage image = flat_image(64, 64, visible, 0.5f);
    error_message(1, [&] { write_display_png("/dev/full", image, {}); });
    error_message(1, [&] { write_display_png(folder / "missing/a.png", image, {}); });
    EXPECT_EQ(folder.file_count(), 0u);
}

} // namespace reradiant
