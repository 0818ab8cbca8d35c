#include "host/exr_limits.h"
#include "host/scene/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <cmath>

#include <fmt/format.h>

namespace reradiant {

namespace {

/// Names of the three channels: R, G, B, or luminance alone.
std::array<const char*, 3> channel_names(const Imf::Header& header, const SourcePosition& at) {
    const auto usable = [&](const char* name) {
        const Imf::Channel* channel = header.channels().findChannel(name);
        return channel != nullptr && channel->xSampling == 1 && channel->ySampling == 1;
    };
    if (usable("R") && usable("G") && usable("B"))
        return {"R", "G", "B"};
    if (usable("Y"))
        return {"Y", "Y", "Y"};
    throw_input_error(at, "the image has no channels R, G and B, and no Y",
                      "give an EXR with colour or luminance, not subsampled");
}

Image read_exr(Imf::InputFile& input, const std::filesystem::path& file) {
    const SourcePosition at{file.string()};
    const auto names = channel_names(input.header(), at);
    const Imath::Box2i window = input.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    check_image_size(file, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    Image image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    const std::size_t pixels = static_cast<std::size_t>(width * height);
    const bool grey = names[0] == names[1];
    std::vector<float> planes((grey ? 1 : 3) * pixels);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < planes.size() / pixels; ++c)
        buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &planes[c * pixels], window));
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    image.rgb.resize(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            image.rgb[3 * i + c] = planes[grey ? i : c * pixels + i];
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        if (!std::isfinite(image.rgb[i]))
            throw_input_error(at,
                              fmt::format("pixel ({}, {}) is not finite",
                                          i / 3 % static_cast<std::size_t>(width),
                                          i / 3 / static_cast<std::size_t>(width)),
                              "write the image without infinities and NaN");
    return image;
}

} // namespace

Image read_exr_image(const std::filesystem::path& file) {
    refuse_hostile_exr(file);
    try {
        Imf::InputFile input(file.c_str());
        return read_exr(input, file);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw_input_error({file.string()},
                          fmt::format("is no EXR file, or a damaged one ({})", error.what()),
                          "write it again");
    }
}

} // namespace reradiant
