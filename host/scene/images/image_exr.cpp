#include "host/scene/images/image_io.h"

#include "host/exr/exr_input.h"
#include "host/exr/exr_window.h"
#include "host/scene/images/exr_colours.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

namespace {

/// A `ColourPart` says which channels of which part hold the colours.
struct ColourPart {
    int part = 0;
    ExrColours colours = ExrColours::Rgb;
    std::vector<std::string> channels;
};

struct Layout {
    ExrColours colours;
    std::vector<std::string> channels;
};
const std::vector<Layout>& layouts() {
    static const std::vector<Layout> known{{ExrColours::Rgb, {"R", "G", "B"}},
                                           {ExrColours::LuminanceChroma, {"Y", "RY", "BY"}},
                                           {ExrColours::Xyz, {"X", "Y", "Z"}},
                                           {ExrColours::Grey, {"Y"}}};
    return known;
}

[[noreturn]] void refuse_channels(Imf::MultiPartInputFile& input, const SourcePosition& at) {
    constexpr std::size_t most_names = 8;
    std::vector<std::string> names;
    for (int part = 0; part < input.parts(); ++part) {
        if (input.header(part).hasType() && Imf::isDeepData(input.header(part).type()))
            throw_input_error(at, "the image is deep", "give a flat image");
        const Imf::ChannelList& channels = input.header(part).channels();
        for (auto channel = channels.begin(); channel != channels.end(); ++channel)
            names.emplace_back(channel.name());
    }
    const bool is_cut = names.size() > most_names;
    names.resize(std::min(names.size(), most_names));
    throw_input_error(at,
                      fmt::format("the image has no channels R, G and B, and no Y; it has {}{}",
                                  fmt::join(names, ", "), is_cut ? " and more" : ""),
                      "give an EXR with colour or luminance; layers have a name of their own");
}

/// Chroma has a quarter of the luminance's pixels in the files that OpenEXR's own class writes,
/// which is what reads them too; everything else must have every pixel.
void check_sampling(const Imf::Header& header, const ColourPart& found, const SourcePosition& at) {
    for (const std::string& name : found.channels) {
        const Imf::Channel* const channel = header.channels().findChannel(name);
        const int step = name == "RY" || name == "BY" ? 2 : 1;
        if (channel->xSampling != step || channel->ySampling != step)
            throw_input_error(at,
                              fmt::format("channel {} holds one of {} columns and one of {} rows",
                                          name, channel->xSampling, channel->ySampling),
                              "write every pixel of it, or luminance with half the chroma");
    }
}

/// Finds the colours in the first part that has some: R, G and B in any part stand before a lone Y
/// in an earlier one, which may be a mask.
ColourPart find_colours(Imf::MultiPartInputFile& input, const SourcePosition& at) {
    for (const auto& [colours, channels] : layouts()) {
        for (int part = 0; part < input.parts(); ++part) {
            const Imf::Header& header = input.header(part);
            if (header.hasType() && Imf::isDeepData(header.type()))
                continue;
            const bool has_all =
                std::all_of(channels.begin(), channels.end(), [&](const std::string& name) {
                    return header.channels().findChannel(name) != nullptr;
                });
            if (!has_all)
                continue;
            ColourPart found{part, colours, channels};
            check_sampling(header, found, at);
            return found;
        }
    }
    refuse_channels(input, at);
}

/// Three values a pixel of the data window; grey is three equal ones.
std::vector<float> read_planes(Imf::MultiPartInputFile& input, const ColourPart& found,
                               const ExrWindow& window) {
    const std::size_t pixels = window.data_pixels();
    std::vector<float> rgb(3 * pixels);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < found.channels.size(); ++c)
        buffer.insert(
            found.channels[c],
            Imf::Slice::Make(Imf::FLOAT, rgb.data() + c, window.data, 3 * sizeof(float),
                             3 * sizeof(float) * static_cast<std::size_t>(window.data_width())));
    Imf::InputPart part(input, found.part);
    part.setFrameBuffer(buffer);
    part.readPixels(window.data.min.y, window.data.max.y);
    if (found.channels.size() == 1)
        for (std::size_t i = 0; i < pixels; ++i)
            rgb[3 * i + 2] = rgb[3 * i + 1] = rgb[3 * i];
    return rgb;
}

/// Reads luminance and chroma by OpenEXR's own class, which knows how chroma was filtered. It reads
/// the first part only.
std::vector<float> read_luminance_chroma(const std::filesystem::path& file, const ColourPart& found,
                                         const ExrWindow& window) {
    if (found.part != 0)
        throw_input_error({file.string()},
                          "luminance and chroma lie in another part than the first",
                          "write R, G and B");
    std::vector<Imf::Rgba> pixels(window.data_pixels());
    const auto width = static_cast<std::ptrdiff_t>(window.data_width());
    Imf::RgbaInputFile input(file.c_str());
    input.setFrameBuffer(pixels.data() - window.data.min.x - window.data.min.y * width, 1,
                         static_cast<std::size_t>(width));
    input.readPixels(window.data.min.y, window.data.max.y);
    std::vector<float> rgb;
    rgb.reserve(3 * pixels.size());
    for (const Imf::Rgba& pixel : pixels)
        rgb.insert(rgb.end(), {pixel.r, pixel.g, pixel.b});
    return rgb;
}

void check_finite(const Image& image, const SourcePosition& at) {
    const auto width = static_cast<std::size_t>(image.width);
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        if (!std::isfinite(image.rgb[i]))
            throw_input_error(
                at, fmt::format("pixel ({}, {}) is not finite", i / 3 % width, i / 3 / width),
                "write the image without infinities and NaN");
}

Image read_image(Imf::MultiPartInputFile& input, const std::filesystem::path& file,
                 ImageEncoding encoding) {
    const SourcePosition at{file.string()};
    const ColourPart found = find_colours(input, at);
    const Imf::Header& header = input.header(found.part);
    if (Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE)
        throw_input_error(at, "the image is a cube map", "write it by latitude and longitude");
    const ExrWindow window(header);
    check_image_size(file, static_cast<std::uint64_t>(window.data_width()),
                     static_cast<std::uint64_t>(window.data_height()));
    check_image_size(file, static_cast<std::uint64_t>(window.width()),
                     static_cast<std::uint64_t>(window.height()));
    check_display_window(file, window, 3);
    std::vector<float> rgb = found.colours == ExrColours::LuminanceChroma
                                 ? read_luminance_chroma(file, found, window)
                                 : read_planes(input, found, window);
    Image image;
    image.width = static_cast<int>(window.width());
    image.height = static_cast<int>(window.height());
    image.rgb = fit_to_display(std::move(rgb), window, 3);
    check_finite(image, at);
    if (encoding == ImageEncoding::Srgb)
        convert_to_linear_srgb(image, header, found.colours, at);
    return image;
}

} // namespace

Image read_exr_image(const std::filesystem::path& file, ImageEncoding encoding) {
    return with_exr_input(
        file, [&](Imf::MultiPartInputFile& input) { return read_image(input, file, encoding); });
}

} // namespace reradiant
