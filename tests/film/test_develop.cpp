#include "host/film/display/develop.h"

#include "host/film/display/picture_levels.h"
#include "reradiant/colour.h"
#include "tests/film/film_fixtures.h"

#include <OpenColorIO/OpenColorIO.h>

#include <cstdlib>

namespace reradiant {

namespace {

const WavelengthGrid visible = grid_from_range(380, 780, 5);

/// Every band of every pixel has the mean of the spectrum over its cell.
SpectralImage image_of(const Spectrum& spectrum, int width = 2, int height = 2) {
    SpectralImage image = flat_image(width, height, visible, 0.0f);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int band = 0; band < visible.count; ++band)
                image.at(x, y, band) = static_cast<float>(
                    spectrum.average(visible.lower_edge_nm(band), visible.upper_edge_nm(band)));
    return image;
}

std::array<double, 2> chromaticity(const Spectrum& spectrum) {
    const Xyz xyz = xyz_of(spectrum);
    const double sum = xyz[0] + xyz[1] + xyz[2];
    return {xyz[0] / sum, xyz[1] / sum};
}

/// Data of a chunk of a PNG; nothing where it has none.
std::string chunk_of(const std::string& png, const std::string& name) {
    const std::size_t place = png.find(name);
    if (place == std::string::npos)
        return {};
    const auto byte = [&](std::size_t k) {
        return static_cast<std::size_t>(static_cast<unsigned char>(png[place - 4 + k]));
    };
    return png.substr(place + 4, (byte(2) << 8) + byte(3));
}

class Develop : public ::testing::Test {
protected:
    void SetUp() override { ::unsetenv("OCIO"); }

    std::string png_of_display(const std::string& display) const {
        DevelopOptions options;
        options.display.display = display;
        write_picture(folder / "a.png", develop(image_of(Spectrum::constant(0.3)), options));
        return file_bytes(folder / "a.png");
    }

    const TemporaryFolder folder;
};

} // namespace

TEST_F(Develop, ALampsWhiteBecomesNeutral) {
    for (const char* lamp : {"A", "FL11", "D50", "HP1"}) {
        const Spectrum light = illuminant_with_luminance(lamp, 0.5);
        DevelopOptions options;
        options.white_xy = chromaticity(light);
        const Picture picture = develop(image_of(light), options);
        // 2 codes: a lamp's lines fall into bands of 5 nm.
        EXPECT_NEAR(picture.rgb[0], picture.rgb[1], 2) << lamp;
        EXPECT_NEAR(picture.rgb[2], picture.rgb[1], 2) << lamp;
        EXPECT_NEAR(picture.rgb[1], 188, 2) << lamp << ": half of white";
    }
}

TEST_F(Develop, AutomaticWhiteIsThatOfMostOfWhatIsLit) {
    SpectralImage image = image_of(illuminant_with_luminance("D50", 0.3), 20, 20);
    const auto paint = [&](int from, int to, const Spectrum& spectrum) {
        const SpectralImage one = image_of(spectrum, 1, 1);
        for (int pixel = from; pixel < to; ++pixel)
            for (int band = 0; band < visible.count; ++band)
                image.at(pixel % 20, pixel / 20, band) = one.at(0, 0, band);
    };
    paint(0, 120, Spectrum::gaussian(600, 30, 1.0)); // a glowing body, brighter than the rest
    paint(120, 220, illuminant_with_luminance("A", 0.001));  // shadow
    paint(220, 224, illuminant_with_luminance("FL2", 50.0)); // a hundredth: a lamp
    DevelopOptions options;
    options.auto_white = true;
    const Picture picture = develop(image, options);
    ASSERT_TRUE(picture.white_xy);
    // 1e-3: bands of 5 nm.
    EXPECT_NEAR((*picture.white_xy)[0], 0.3457, 1e-3);
    EXPECT_NEAR((*picture.white_xy)[1], 0.3585, 1e-3);
    EXPECT_FALSE(develop(image_of(Spectrum::constant(0.0)), options).white_xy) << "all is black";
    EXPECT_FALSE(develop(image_of(Spectrum::gaussian(600, 2, 1.0)), options).white_xy)
        << "light of a laser is no white, and no reason to lose a render";
}

TEST_F(Develop, AutomaticExposureShowsTheMedianAtThreeFifths) {
    DevelopOptions options;
    options.auto_exposure = true;
    const Spectrum d65 = illuminant_with_luminance("D65", 1.0);
    EXPECT_EQ(develop(image_of(d65.scaled(0.5)), options).exposure_ev, 0.0);
    // Tenths of EV.
    EXPECT_NEAR(develop(image_of(d65.scaled(0.001)), options).exposure_ev, 9.2, 1e-9);
    EXPECT_NEAR(develop(image_of(d65.scaled(40.0)), options).exposure_ev, -6.1, 1e-9);
    EXPECT_EQ(develop(image_of(d65.scaled(0.0)), options).exposure_ev, 0.0);
}

TEST_F(Develop, CompressionCountsWhatWasOutsideAndClipsNothing) {
    const SpectralImage green = image_of(Spectrum::gaussian(520, 5, 1));
    DevelopOptions options;
    const Picture clip = develop(green, options);
    options.gamut = Gamut::Compress;
    const Picture compress = develop(green, options);
    EXPECT_EQ(clip.out_of_gamut, 4u);
    EXPECT_EQ(compress.out_of_gamut, 4u);
    EXPECT_EQ(clip.rgb[0], 0);
    EXPECT_GT(compress.rgb[1], compress.rgb[0]);
    options.display.display = "REC.2100-PQ"; // white is 100 times as bright there
    EXPECT_EQ(develop(image_of(illuminant_with_luminance("D65", 2.0)), options).out_of_gamut, 0u);
}

TEST_F(Develop, GreysAreTheSameWithCompression) {
    for (const double level : {0.001, 0.02, 0.18, 0.5, 0.9, 0.999, 1.5}) {
        const SpectralImage grey = image_of(illuminant_with_luminance("D65", level));
        DevelopOptions options;
        const Picture clip = develop(grey, options);
        options.gamut = Gamut::Compress;
        EXPECT_EQ(develop(grey, options).rgb, clip.rgb) << level;
    }
}

TEST_F(Develop, PngsSayWhatTheirCodesStandFor) {
    const std::string srgb = png_of_display("");
    EXPECT_EQ(chunk_of(srgb, "sRGB"), std::string(1, '\0'));
    EXPECT_EQ(chunk_of(srgb, "cICP"), "");
    const std::string pq = png_of_display("REC.2100-PQ");
    EXPECT_EQ(chunk_of(pq, "cICP"), std::string("\x09\x10\x00\x01", 4));
    EXPECT_EQ(chunk_of(pq, "sRGB"), "");
    const std::string p3 = png_of_display("G2.6-P3-D65");
    EXPECT_EQ(chunk_of(p3, "gAMA"), std::string("\x00\x00\x96\x3e", 4)) << "1e5 / 2.6";
    // x of the white, 0.3127, and y of red, 0.32, in units of 1e-5.
    EXPECT_EQ(chunk_of(p3, "cHRM").substr(0, 4), std::string("\x00\x00\x7a\x26", 4));
    EXPECT_EQ(chunk_of(p3, "cHRM").substr(12, 4), std::string("\x00\x00\x7d\x00", 4));
    EXPECT_LT(p3.find("cHRM"), p3.find("IDAT"));
    EXPECT_LT(pq.find("cICP"), pq.find("IDAT"));
}

TEST_F(Develop, JpegsAreOfTheSizeAskedForAndForSrgbAlone) {
    const SpectralImage image = image_of(Spectrum::constant(0.3), 40, 30);
    write_picture(folder / "a.JPG", develop(image, {}));
    const std::string jpeg = file_bytes(folder / "a.JPG");
    EXPECT_EQ(jpeg.substr(0, 3), "\xff\xd8\xff");
    const std::size_t frame = jpeg.find("\xff\xc0"); // height and width behind length and depth
    ASSERT_NE(frame, std::string::npos);
    EXPECT_EQ(jpeg.substr(frame + 5, 4), std::string("\x00\x1e\x00\x28", 4));
    DevelopOptions options;
    options.display.display = "G2.6-P3-D65";
    error_message(2, [&] { write_picture(folder / "b.jpg", develop(image, options)); });
    EXPECT_EQ(folder.file_count(), 1u);
    error_message(1, [&] { write_picture("/dev/full", develop(image, {})); });
}

TEST_F(Develop, WhitesThatNoEyeAdaptsToAreRefused) {
    DevelopOptions options;
    for (const std::array<double, 2> xy :
         {std::array{0.0, 0.5}, {0.7, 0.4}, {-0.1, 0.3}, {0.569, 0.4303}, {std::nan(""), 0.3}}) {
        options.white_xy = xy;
        const std::string message = error_message(2, [&] { check_develop(options); });
        EXPECT_NE(message.find("--white"), std::string::npos) << message;
    }
}

TEST_F(Develop, CompressionIsForTheBuiltInDisplays) {
    put_bytes(folder / "config.ocio",
              "ocio_profile_version: 2\nroles:\n  default: linear\n  scene_linear: linear\n"
              "displays:\n  Screen:\n    - !<View> {name: Raw, colorspace: linear}\n"
              "active_displays: []\nactive_views: []\n"
              "colorspaces:\n  - !<ColorSpace>\n    name: linear\n    isdata: false\n");
    DevelopOptions options;
    options.display.ocio_config = folder / "config.ocio";
    check_develop(options);
    options.gamut = Gamut::Compress;
    const std::string message = error_message(2, [&] { check_develop(options); });
    EXPECT_NE(message.find("--gamut"), std::string::npos) << message;
}

TEST_F(Develop, ConfigurationsInsideTheLibraryWorkOrAreExplained) {
    DevelopOptions options;
    options.display.ocio_config = "ocio://default";
    if (OCIO_VERSION_HEX >= 0x02020000) {
        check_develop(options);
        return;
    }
    const std::string message = error_message(2, [&] { check_develop(options); });
    EXPECT_NE(message.find("OpenColorIO 2.2"), std::string::npos) << message;
}

} // namespace reradiant
