#include "host/scene/images/image_io.h"
#include "reradiant/colour.h"
#include "reradiant/scene_file.h"
#include "tests/scene/scratch.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <cmath>
#include <map>

using namespace reradiant;
using namespace reradiant::testing;

// Images of other programs: windows, colours, layouts.

namespace {

Imath::Box2i box(int left, int top, int right, int bottom) {
    return {Imath::V2i(left, top), Imath::V2i(right, bottom)};
}
const Imath::Box2i small = box(0, 0, 3, 2);

/// Channels of one value each.
using Channels = std::map<std::string, float>;

class ExrImages : public Scratch {
protected:
    /// Writes scan lines of one part; every pixel of a channel is the same.
    void put(const Channels& channels, const Imf::Header& given) {
        Imf::Header header = given;
        const Imath::Box2i& window = header.dataWindow();
        const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
        const std::size_t pixels =
            static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        Imf::FrameBuffer frame;
        std::map<std::string, std::vector<float>> values;
        for (const auto& [name, value] : channels) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            values[name].assign(pixels, value);
            frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values[name].data(), window));
        }
        Imf::OutputFile output(file().c_str(), header);
        output.setFrameBuffer(frame);
        output.writePixels(window.max.y - window.min.y + 1);
    }
    void put_rgb(float r, float g, float b, const Imf::Header& header) {
        put({{"R", r}, {"G", g}, {"B", b}}, header);
    }
    std::filesystem::path file() const { return folder / "a.exr"; }
    Image read(ImageEncoding encoding = ImageEncoding::Srgb) const {
        return read_exr_image(file(), encoding);
    }
    void expect_all(const Image& image, const std::array<double, 3>& rgb, double tolerance) const {
        for (std::size_t i = 0; i < image.rgb.size(); ++i)
            ASSERT_NEAR(image.rgb[i], rgb[i % 3], tolerance) << "value " << i;
    }
    void expect_refused(const std::string& part_of_message) const {
        const Caught error = error_of([&] { read(); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_NE(error.text.find(part_of_message), std::string::npos) << error.text;
    }
};

Imf::Header with_chromaticities(const Imf::Chromaticities& chromaticities) {
    Imf::Header header(small, small);
    Imf::addChromaticities(header, chromaticities);
    return header;
}

} // namespace

TEST_F(ExrImages, Case69OutsideTheDataWindowIsBlack) {
    put_rgb(1, 2, 3, Imf::Header(box(-2, 5, 1, 8), box(-1, 6, 5, 6)));
    const Image image = read();
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.height, 4);
    std::vector<float> wanted(48, 0.0f);
    for (std::size_t pixel = 5; pixel < 8; ++pixel)
        for (std::size_t c = 0; c < 3; ++c)
            wanted[3 * pixel + c] = static_cast<float>(c + 1);
    EXPECT_EQ(image.rgb, wanted);
    put_rgb(1, 2, 3, Imf::Header(small, box(10, 10, 12, 12)));
    EXPECT_EQ(read().rgb, std::vector<float>(36, 0.0f));
}

TEST_F(ExrImages, Case69DisplayWindowsThatTheFileCannotFillAreRefused) {
    put_rgb(1, 2, 3, Imf::Header(box(0, 0, 7999, 7999), small));
    expect_refused("display window");
    put_rgb(1, 2, 3, Imf::Header(box(0, 0, 1000000, 0), small));
    expect_refused("1000001 x 1");
}

TEST_F(ExrImages, HalfFloatsMayRoundOutOfTheGamut) {
    // Red 0.8 of linear sRGB in XYZ, to half floats: blue comes back as -1.5e-5.
    const std::array<float, 3> xyz{0.32983f, 0.170074f, 0.015461f};
    Imf::Header header(small, small);
    Imf::FrameBuffer frame;
    std::map<std::string, std::vector<half>> values;
    for (const auto& [name, value] :
         std::map<std::string, float>{{"X", xyz[0]}, {"Y", xyz[1]}, {"Z", xyz[2]}}) {
        header.channels().insert(name, Imf::Channel(Imf::HALF));
        values[name].assign(12, half(value));
        frame.insert(name, Imf::Slice::Make(Imf::HALF, values[name].data(), small));
    }
    {
        Imf::OutputFile output(file().c_str(), header);
        output.setFrameBuffer(frame);
        output.writePixels(3);
    }
    expect_all(read(), {0.8, 0.0, 0.0}, 1e-3);
}

TEST_F(ExrImages, AReflectanceLiesWithinZeroAndOne) {
    const auto scene = [&](const std::string& high) {
        return write("scene.toml",
                     replaced(SMALL_SCENE, "reflectance = 0.5\n",
                              "reflectance = { texture = \"t\"" + high + " }\n") +
                         "[[texture]]\nname = \"t\"\ntype = \"image\"\nfile = \"a.exr\"\n");
    };
    for (const float wrong : {1.5f, -0.1f, 255.0f}) {
        put_rgb(0.5f, wrong, 0.5f, Imf::Header(small, small));
        const auto file = scene("");
        const Caught error = error_of([&] { load_scene(file); });
        EXPECT_EQ(error.exit_code, 2);
        EXPECT_NE(error.text.find("pixel (0, 0)"), std::string::npos) << error.text;
    }
    put_rgb(0.5f, 1.5f, 0.5f, Imf::Header(small, small));
    EXPECT_NO_THROW(load_scene(scene(", high = 0.6")));
}

TEST_F(ExrImages, XyzByChromaticitiesOrByNameIsConverted) {
    const Xyz xyz{0.5, 0.6, 0.4};
    const auto wanted = xyz_to_linear_srgb(xyz);
    const float third = 1.0f / 3.0f;
    put_rgb(0.5f, 0.6f, 0.4f, with_chromaticities({{1, 0}, {0, 1}, {0, 0}, {third, third}}));
    expect_all(read(), wanted, 1e-5); // matrices of single precision
    expect_all(read(ImageEncoding::Linear), {0.5, 0.6, 0.4}, 1e-7);
    put({{"X", 0.5f}, {"Y", 0.6f}, {"Z", 0.4f}}, Imf::Header(small, small));
    expect_all(read(), wanted, 1e-6);
}

TEST_F(ExrImages, PrimariesAndWhiteOfTheFileAreItsOwn) {
    // ITU-R BT.2087-0: the matrix from BT.2020 to BT.709 has rows that sum to 1 (one white), and
    // these elements.
    put_rgb(0.5f, 0.5f, 0.5f,
            with_chromaticities(
                {{0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f}}));
    expect_all(read(), {0.5, 0.5, 0.5}, 1e-3);
    put_rgb(0.5f, 0.6f, 0.55f,
            with_chromaticities(
                {{0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f}}));
    expect_all(read(),
               {1.6605 * 0.5 - 0.5876 * 0.6 - 0.0728 * 0.55,
                -0.1246 * 0.5 + 1.1329 * 0.6 - 0.0083 * 0.55,
                -0.0182 * 0.5 - 0.1006 * 0.6 + 1.1187 * 0.55},
               2e-3);
    // Nothing adapts: the file's white is that of D50 here, of XYZ (0.9642, 1, 0.8251).
    put_rgb(
        0.5f, 0.5f, 0.5f,
        with_chromaticities({{0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3457f, 0.3585f}}));
    expect_all(read(), xyz_to_linear_srgb({0.5 * 0.9643, 0.5, 0.5 * 0.8251}), 1e-4);
}

TEST_F(ExrImages, ChromaticitiesOfSrgbChangeNothing) {
    put_rgb(0.1f, -0.2f, 0.3f, with_chromaticities(Imf::Chromaticities()));
    const Image image = read();
    EXPECT_EQ(image.rgb[0], 0.1f);
    EXPECT_EQ(image.rgb[1], -0.2f);
}

TEST_F(ExrImages, WhatSrgbCannotHoldIsRefused) {
    const float third = 1.0f / 3.0f;
    put_rgb(0.4f, 0.8f, 0.2f, with_chromaticities({{1, 0}, {0, 1}, {0, 0}, {third, third}}));
    expect_refused("pixel (0, 0) lies outside the gamut");
    put_rgb(0.4f, 0.8f, 0.2f, with_chromaticities({{1, 0}, {1, 0}, {1, 0}, {third, third}}));
    expect_refused("no colour space");
    put_rgb(0.4f, 0.8f, 0.2f, with_chromaticities({{1, 0}, {0, 1}, {0, 0}, {0, 0}}));
    expect_refused("no colour space");
}

TEST_F(ExrImages, LuminanceAndChromaAreConverted) {
    const std::vector<Imf::Rgba> pixels(64 * 32, Imf::Rgba(0.8f, 0.3f, 0.05f));
    for (const Imf::RgbaChannels channels : {Imf::WRITE_YC, Imf::WRITE_YCA}) {
        {
            Imf::RgbaOutputFile output(file().c_str(), box(0, 0, 63, 31), box(0, 0, 63, 31),
                                       channels);
            output.setFrameBuffer(pixels.data(), 1, 64);
            output.writePixels(32);
        }
        const Image image = read();
        EXPECT_EQ(image.width, 64);
        EXPECT_EQ(image.height, 32);
        // Half floats, twice.
        expect_all(image, {0.8, 0.3, 0.05}, 2e-3);
    }
    put({{"Y", 0.5f}, {"RY", 0.1f}, {"BY", 0.1f}}, Imf::Header(small, small));
    expect_refused("channel RY holds one of 1 columns");
    put({{"Y", 0.5f}, {"A", 1.0f}}, Imf::Header(small, small));
    expect_all(read(), {0.5, 0.5, 0.5}, 0.0);
}

TEST_F(ExrImages, TilesAndLevelsAreReadAtFullSize) {
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
        Imf::Header header(box(0, 0, 19, 9), box(0, 0, 19, 9));
        header.setTileDescription(Imf::TileDescription(8, 8, mode));
        for (const char* name : {"R", "G", "B"})
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        {
            Imf::TiledOutputFile output(file().c_str(), header);
            for (int y = 0; y < output.numYLevels(); ++y)
                for (int x = 0; x < output.numXLevels(); ++x) {
                    if (!output.isValidLevel(x, y))
                        continue;
                    const std::vector<float> values(200, x == 0 && y == 0 ? 0.25f : 9.0f);
                    Imf::FrameBuffer frame;
                    for (const char* name : {"R", "G", "B"})
                        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(),
                                                            output.dataWindowForLevel(x, y)));
                    output.setFrameBuffer(frame);
                    output.writeTiles(0, output.numXTiles(x) - 1, 0, output.numYTiles(y) - 1, x, y);
                }
        }
        const Image image = read();
        EXPECT_EQ(image.width, 20);
        EXPECT_EQ(image.height, 10);
        expect_all(image, {0.25, 0.25, 0.25}, 0.0);
    }
}

TEST_F(ExrImages, OfSeveralPartsTheFirstWithColoursIsRead) {
    for (const char* lone : {"Z", "Y"}) { // depth, a mask
        std::vector<Imf::Header> headers(2, Imf::Header(small, small));
        headers[0].setName("other");
        headers[0].channels().insert(lone, Imf::Channel(Imf::FLOAT));
        headers[1].setName("picture");
        for (const char* name : {"R", "G", "B"})
            headers[1].channels().insert(name, Imf::Channel(Imf::FLOAT));
        for (Imf::Header& header : headers)
            header.setType(Imf::SCANLINEIMAGE);
        {
            Imf::MultiPartOutputFile output(file().c_str(), headers.data(), 2);
            const std::vector<float> colours(12, 0.5f), others(12, 0.25f);
            for (int part = 0; part < 2; ++part) {
                Imf::FrameBuffer frame;
                for (const char* name : {"R", "G", "B"})
                    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, colours.data(), small));
                frame.insert(lone, Imf::Slice::Make(Imf::FLOAT, others.data(), small));
                Imf::OutputPart writer(output, part);
                writer.setFrameBuffer(frame);
                writer.writePixels(3);
            }
        }
        expect_all(read(), {0.5, 0.5, 0.5}, 0.0);
    }
}

TEST_F(ExrImages, OtherLayoutsAreRefusedByName) {
    put({{"view.R", 0.5f}, {"view.G", 0.5f}, {"view.B", 0.5f}}, Imf::Header(small, small));
    expect_refused("view.G");
    Imf::Header header(small, small);
    Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
    put_rgb(1, 1, 1, header);
    expect_refused("cube map");
}
