#include "host/film/spectral_channels.h"
#include "tests/film/film_fixtures.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>

namespace reradiant {

TEST(SpectralExr, ValuesStatisticsAndAttributesReadBackBitForBit) {
    const TemporaryFolder folder;
    SpectralImage image = patterned_image(7, 5, grid_from_range(300, 780, 10));
    image.sample_count.assign(35, 64.0f);
    image.variance_y.assign(35, 0.25f);
    image.variance_bands.assign(image.values.begin(), image.values.end());
    image.attributes = {{"reradiant:sceneHash", "00ff"}, {"seed", "7"}};
    write_spectral_exr(folder / "a.exr", image);

    const SpectralImage back = read_spectral_exr(folder / "a.exr");
    EXPECT_EQ(back.width, 7);
    EXPECT_EQ(back.height, 5);
    EXPECT_EQ(back.bands, image.bands);
    EXPECT_EQ(back.values, image.values);
    EXPECT_EQ(back.sample_count, image.sample_count);
    EXPECT_EQ(back.variance_y, image.variance_y);
    EXPECT_EQ(back.variance_bands, image.variance_bands);
    EXPECT_EQ(back.attributes.at("reradiant:sceneHash"), "00ff");
    EXPECT_EQ(back.attributes.at("reradiant:seed"), "7");
    EXPECT_EQ(back.attributes.at("reradiant:quantity"), "radiance per nm");
}

TEST(SpectralExr, LayoutIsThatOfFichetPacanowskiAndWilkie) {
    const TemporaryFolder folder;
    SpectralImage image = patterned_image(4, 3, grid_from_range(380, 780, 10));
    image.sample_count.assign(12, 1.0f);
    write_spectral_exr(folder / "a.exr", image, 1.5);

    Imf::MultiPartInputFile file((folder / "a.exr").c_str());
    ASSERT_EQ(file.parts(), 2);
    const Imf::Header& header = file.header(0);
    const auto text = [&](const char* name) {
        return header.typedAttribute<Imf::StringAttribute>(name).value();
    };
    EXPECT_EQ(text("spectralLayoutVersion"), "1.0");
    EXPECT_EQ(text("emissiveUnits"), "W.m^-2.sr^-1");
    EXPECT_EQ(header.typedAttribute<Imf::FloatAttribute>("EV").value(), 1.5f);
    for (const char* name : {"R", "G", "B", "S0.380,000000nm", "S0.780,000000nm"}) {
        const Imf::Channel* const channel = header.channels().findChannel(name);
        ASSERT_NE(channel, nullptr) << name;
        EXPECT_EQ(channel->type, Imf::FLOAT) << name;
    }
    EXPECT_EQ(file.header(1).name(), "statistics");
    EXPECT_NE(file.header(1).channels().findChannel("sampleCount"), nullptr);
}

TEST(SpectralExr, Case54ValuesBeyondHalfFloatsSurvive) {
    const TemporaryFolder folder;
    SpectralImage image = flat_image(2, 1, grid_from_range(500, 510, 10), 0.0f);
    image.values = {65520.0f, 2e-8f, 1e-38f, 3e38f};
    write_spectral_exr(folder / "a.exr", image);
    EXPECT_EQ(read_spectral_exr(folder / "a.exr").values, image.values);
}

TEST(SpectralExr, GridsThatSixDecimalsDoNotHoldReadBackExactly) {
    const TemporaryFolder folder;
    for (const WavelengthGrid& grid :
         {WavelengthGrid{380.0, 1.0 / 3.0, 10}, WavelengthGrid{405.0, 7.5, 1}}) {
        write_spectral_exr(folder / "a.exr", patterned_image(2, 2, grid));
        EXPECT_EQ(read_spectral_exr(folder / "a.exr").bands, grid);
    }
}

TEST(SpectralExr, Case55ThousandsOfBandsAreWrittenAndRead) {
    const TemporaryFolder folder;
    const SpectralImage image = patterned_image(16, 16, WavelengthGrid{300.0, 0.1, 5778});
    write_spectral_exr(folder / "a.exr", image);
    EXPECT_EQ(read_spectral_exr(folder / "a.exr").values, image.values);
}

TEST(SpectralExr, Case53FullDiskGivesARunTimeErrorAndKeepsThePreviousFile) {
    // Large enough that the error shows within a write, and small enough that it shows on close.
    for (const int side : {2, 64}) {
        const SpectralImage image = patterned_image(side, side, grid_from_range(380, 780, 10));
        const std::string message =
            error_message(1, [&] { write_spectral_exr("/dev/full", image); });
        EXPECT_NE(message.find("/dev/full"), std::string::npos) << message;
    }
}

TEST(SpectralExr, Case53FailedWriteLeavesThePreviousFileAndNoTemporaryOne) {
    const TemporaryFolder folder;
    const SpectralImage image = patterned_image(4, 4, grid_from_range(380, 780, 10));
    write_spectral_exr(folder / "a.exr", image);
    const std::string before = file_bytes(folder / "a.exr");

    SpectralImage broken = image;
    broken.values.pop_back();
    error_message(1, [&] { write_spectral_exr(folder / "a.exr", broken); });
    error_message(1, [&] { write_spectral_exr(folder / "missing/a.exr", image); });
    std::filesystem::create_directories(folder / "taken.exr/inside");
    error_message(1, [&] { write_spectral_exr(folder / "taken.exr", image); });

    EXPECT_EQ(file_bytes(folder / "a.exr"), before);
    EXPECT_EQ(folder.file_count(), 2u); // a.exr and the folder taken.exr
    write_spectral_exr(folder / "a.exr", image);
    EXPECT_EQ(folder.file_count(), 2u);
}

TEST(SpectralExr, RgbOfEqualEnergyIsThatOfUnitXyz) {
    const std::vector<float> rgb =
        linear_srgb(flat_image(1, 1, grid_from_range(380, 780, 5), 1.0f));
    // The equal-energy stimulus has XYZ (1, 1, 1): the row sums of the matrix of IEC 61966-2-1.
    // 2e-3: the sums of the 1931 observer's functions agree to 1e-4, and 380-780 nm leaves a
    // little out.
    EXPECT_NEAR(rgb[0], 1.2048, 2e-3);
    EXPECT_NEAR(rgb[1], 0.9483, 2e-3);
    EXPECT_NEAR(rgb[2], 0.9089, 2e-3);
}

TEST(SpectralExr, RgbChannelsCarryTheExposureAndTheBandsDoNot) {
    const TemporaryFolder folder;
    const SpectralImage image = flat_image(1, 1, grid_from_range(380, 780, 5), 0.75f);
    write_spectral_exr(folder / "a.exr", image, 2.0);
    EXPECT_EQ(read_spectral_exr(folder / "a.exr").values, image.values);

    Imf::InputFile file((folder / "a.exr").c_str());
    float red = 0.0f;
    Imf::FrameBuffer frame;
    frame.insert("R",
                 Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&red), sizeof red, sizeof red));
    file.setFrameBuffer(frame);
    file.readPixels(0, 0);
    EXPECT_FLOAT_EQ(red, 4.0f * linear_srgb(image)[0]);
}

} // namespace reradiant
