#include "host/film/exr_channels.h"
#include "tests/film/film_fixtures.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr float grey = 0.5f;

/// Writes an EXR of one part as another program might: every pixel of every channel is 0.5.
void write_foreign(const std::filesystem::path& file, const std::vector<std::string>& names,
                   Imf::PixelType type, const Imath::Box2i& window, const Imath::Box2i& display) {
    Imf::Header header(display, window);
    Imf::FrameBuffer frame;
    const auto pixels = static_cast<std::size_t>((window.max.x - window.min.x + 1) *
                                                 (window.max.y - window.min.y + 1));
    const std::vector<float> floats(pixels, grey);
    const std::vector<half> halves(pixels, half(grey));
    const std::vector<unsigned> integers(pixels, 1);
    for (const std::string& name : names) {
        header.channels().insert(name, Imf::Channel(type));
        const void* const values = type == Imf::HALF   ? static_cast<const void*>(halves.data())
                                   : type == Imf::UINT ? static_cast<const void*>(integers.data())
                                                       : static_cast<const void*>(floats.data());
        frame.insert(name, Imf::Slice::Make(type, values, window));
    }
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(frame);
    output.writePixels(window.max.y - window.min.y + 1);
}

void write_foreign(const std::filesystem::path& file, const std::vector<std::string>& names,
                   Imf::PixelType type, const Imath::Box2i& window) {
    write_foreign(file, names, type, window, window);
}

const Imath::Box2i small_window(Imath::V2i(0), Imath::V2i(3, 2));

} // namespace

TEST(ForeignExr, ImageOfAnotherProgramIsRead) {
    const TemporaryFolder folder;
    const Imath::Box2i window(Imath::V2i(-5, 10), Imath::V2i(-2, 12));
    write_foreign(folder / "a.exr", {"S0.400,000000nm", "S0.420.0nm", "S0.410nm", "G", "Z"},
                  Imf::FLOAT, window);
    const SpectralImage image = read_spectral_exr(folder / "a.exr");
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.height, 3);
    EXPECT_EQ(image.left, -5);
    EXPECT_EQ(image.top, 10);
    EXPECT_EQ(image.bands, (WavelengthGrid{400.0, 10.0, 3}));
    EXPECT_EQ(image.values, std::vector<float>(36, grey));
    write_spectral_exr(folder / "b.exr", image);
    const SpectralImage again = read_spectral_exr(folder / "b.exr");
    EXPECT_EQ(again.left, -5);
    EXPECT_EQ(again.values, image.values);
}

TEST(ForeignExr, Case54HalfFloatsAreReadAsTheyAre) {
    // Half floats in files of other programs are read as they are; this program writes none.
    const TemporaryFolder folder;
    write_foreign(folder / "a.exr", {"S0.400,000000nm"}, Imf::HALF, small_window);
    EXPECT_EQ(read_spectral_exr(folder / "a.exr").values, std::vector<float>(12, grey));
    write_foreign(folder / "b.exr", {"S0.400,000000nm"}, Imf::UINT, small_window);
    const std::string message = error_message(2, [&] { read_spectral_exr(folder / "b.exr"); });
    EXPECT_NE(message.find("S0.400,000000nm"), std::string::npos) << message;
}

TEST(ForeignExr, BandsNamedWithThreeDecimalsAreEvenWithinTheirRounding) {
    // The names are those that pbrt-v4 gives sixteen bands from 360 to 830 nm.
    std::vector<std::string> names;
    for (int band = 0; band < 16; ++band) {
        std::string name = fmt::format("S0.{:.3f}nm", 374.6875 + 29.375 * band);
        name[name.rfind('.')] = ',';
        names.push_back(name);
    }
    const TemporaryFolder folder;
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
        write_foreign(folder / "a.exr", names, type, small_window);
        EXPECT_EQ(read_spectral_exr(folder / "a.exr").bands,
                  (WavelengthGrid{374.6875, 29.375, 16}));
    }
}

TEST(ForeignExr, Case69ImageIsTheDisplayWindow) {
    const TemporaryFolder folder;
    const Imath::Box2i display(Imath::V2i(0), Imath::V2i(4, 3));
    const Imath::Box2i data(Imath::V2i(3, -1), Imath::V2i(6, 1));
    write_foreign(folder / "a.exr", {"S0.400nm", "S0.410nm"}, Imf::FLOAT, data, display);
    const SpectralImage image = read_spectral_exr(folder / "a.exr");
    EXPECT_EQ(image.width, 5);
    EXPECT_EQ(image.height, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            EXPECT_EQ(image.at(x, y, 1), x >= 3 && y <= 1 ? grey : 0.0f) << x << ' ' << y;
}

TEST(ForeignExr, Case69ImagesOfDifferentDisplayWindowsAreNotCompared) {
    const TemporaryFolder folder;
    const Imath::Box2i moved(Imath::V2i(1, 0), Imath::V2i(4, 2));
    write_foreign(folder / "a.exr", {"S0.400nm"}, Imf::FLOAT, small_window);
    write_foreign(folder / "b.exr", {"S0.400nm"}, Imf::FLOAT, moved);
    const SpectralImage a = read_spectral_exr(folder / "a.exr"),
                        b = read_spectral_exr(folder / "b.exr");
    const std::string message = error_message(2, [&] { compare_images(a, b); });
    EXPECT_NE(message.find("display windows differ"), std::string::npos) << message;
    // The third file has the data of the first, cropped out of a larger film.
    write_foreign(folder / "c.exr", {"S0.400nm"}, Imf::FLOAT, small_window,
                  {Imath::V2i(0), Imath::V2i(9, 9)});
    error_message(2, [&] { compare_images(a, read_spectral_exr(folder / "c.exr")); });
}

TEST(ForeignExr, Case69DisplayWindowThatTheFileCannotFillIsRefused) {
    const TemporaryFolder folder;
    write_foreign(folder / "a.exr", {"S0.400nm"}, Imf::FLOAT, small_window,
                  {Imath::V2i(0), Imath::V2i(65535, 65535)});
    const std::string message = error_message(2, [&] { read_spectral_exr(folder / "a.exr"); });
    EXPECT_NE(message.find("display window"), std::string::npos) << message;
}

TEST(ForeignExr, ReflectanceIsNotTakenForRadiance) {
    const TemporaryFolder folder;
    write_foreign(folder / "a.exr", {"T.400nm", "T.410nm"}, Imf::FLOAT, small_window);
    const std::string message = error_message(2, [&] { read_spectral_exr(folder / "a.exr"); });
    EXPECT_NE(message.find("T channels"), std::string::npos) << message;
}

TEST(ForeignExr, MissingBandAndMissingSpectrumAreRefused) {
    const TemporaryFolder folder;
    write_foreign(folder / "gap.exr", {"S0.400nm", "S0.410nm", "S0.430nm"}, Imf::FLOAT,
                  small_window);
    error_message(2, [&] { read_spectral_exr(folder / "gap.exr"); });
    write_foreign(folder / "name.exr", {"S0.400nm", "S0.410nm", "S0.420mn"}, Imf::FLOAT,
                  small_window);
    const std::string message = error_message(2, [&] { read_spectral_exr(folder / "name.exr"); });
    EXPECT_NE(message.find("S0.420mn"), std::string::npos) << message;
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
