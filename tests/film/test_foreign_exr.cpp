#include "host/film/exr_channels.h"
#include "tests/film/film_fixtures.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>

namespace reradiant {

namespace {

constexpr float grey = 0.5f;

/// Writes an EXR of one part as another program might: every pixel of every channel is 0.5.
void write_foreign(const std::filesystem::path& file, const std::vector<std::string>& names,
                   Imf::PixelType type, const Imath::Box2i& window) {
    Imf::Header header(window, window);
    Imf::FrameBuffer frame;
    const auto pixels = static_cast<std::size_t>((window.max.x - window.min.x + 1) *
                                                 (window.max.y - window.min.y + 1));
    const std::vector<float> floats(pixels, grey);
    const std::vector<half> halves(pixels, half(grey));
    for (const std::string& name : names) {
        header.channels().insert(name, Imf::Channel(type));
        const void* const values = type == Imf::HALF ? static_cast<const void*>(halves.data())
                                                     : static_cast<const void*>(floats.data());
        frame.insert(name, Imf::Slice::Make(type, values, window));
    }
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(frame);
    output.writePixels(window.max.y - window.min.y + 1);
}

const Imath::Box2i small_window(Imath::V2i(0), Imath::V2i(3, 2));

} // namespace

TEST(ForeignExr, ImageOfAnotherProgramIsRead) {
    const TemporaryFolder folder;
    const Imath::Box2i window(Imath::V2i(-5, 10), Imath::V2i(-2, 12));
    write_foreign(folder / "a.exr", {"S0.400,000000nm", "S0.420,0nm", "S0.410nm", "G", "Z"},
                  Imf::FLOAT, window);
    const SpectralImage image = read_spectral_exr(folder / "a.exr");
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.height, 3);
    EXPECT_EQ(image.bands, (WavelengthGrid{400.0, 10.0, 3}));
    EXPECT_EQ(image.values, std::vector<float>(36, grey));
}

TEST(ForeignExr, Case54HalfFloatChannelsAreRefused) {
    const TemporaryFolder folder;
    write_foreign(folder / "a.exr", {"S0.400,000000nm"}, Imf::HALF, small_window);
    const std::string message = error_message(2, [&] { read_spectral_exr(folder / "a.exr"); });
    EXPECT_NE(message.find("S0.400,000000nm"), std::string::npos) << message;
}

TEST(ForeignExr, MissingBandAndMissingSpectrumAreRefused) {
    const TemporaryFolder folder;
    write_foreign(folder / "gap.exr", {"S0.400nm", "S0.410nm", "S0.430nm"}, Imf::FLOAT,
                  small_window);
    error_message(2, [&] { read_spectral_exr(folder / "gap.exr"); });
    write_foreign(folder / "rgb.exr", {"R", "G", "B"}, Imf::FLOAT, small_window);
    error_message(2, [&] { read_spectral_exr(folder / "rgb.exr"); });
    EXPECT_EQ(exr_channel_names(folder / "rgb.exr"), (std::vector<std::string>{"B", "G", "R"}));
}

TEST(ForeignExr, StatisticsWithAnotherDataWindowAreRefused) {
    const TemporaryFolder folder;
    const Imath::Box2i wider(Imath::V2i(0), Imath::V2i(4, 2));
    Imf::Header headers[2] = {Imf::Header(small_window, small_window),
                              Imf::Header(small_window, wider)};
    headers[0].setName("image");
    headers[0].channels().insert("S0.400nm", Imf::Channel(Imf::FLOAT));
    headers[1].setName("statistics");
    headers[1].channels().insert("sampleCount", Imf::Channel(Imf::FLOAT));
    headers[0].setType(Imf::SCANLINEIMAGE);
    headers[1].setType(Imf::SCANLINEIMAGE);
    {
        Imf::MultiPartOutputFile output((folder / "a.exr").c_str(), headers, 2);
        const std::vector<float> values(15, grey);
        const char* const names[] = {"S0.400nm", "sampleCount"};
        for (int part = 0; part < 2; ++part) {
            Imf::FrameBuffer frame;
            frame.insert(names[part],
                         Imf::Slice::Make(Imf::FLOAT, values.data(), headers[part].dataWindow()));
            Imf::OutputPart writer(output, part);
            writer.setFrameBuffer(frame);
            writer.writePixels(3);
        }
    }
    const std::string message = error_message(2, [&] { read_spectral_exr(folder / "a.exr"); });
    EXPECT_NE(message.find("data windows"), std::string::npos) << message;
}

} // namespace reradiant
