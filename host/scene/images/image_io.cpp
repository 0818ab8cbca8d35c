#include "host/scene/images/image_io.h"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/core.h>

namespace reradiant {

namespace {

enum class ImageKind { Png, Exr, Other };

/// Finds the kind of a file from its first bytes, since a name may say anything.
ImageKind kind_of(const std::filesystem::path& file) {
    constexpr std::array<unsigned char, 4> png{0x89, 'P', 'N', 'G'}, exr{0x76, 0x2f, 0x31, 0x01};
    std::array<char, 4> bytes{};
    std::ifstream(file, std::ios::binary).read(bytes.data(), bytes.size());
    const auto starts_with = [&](const std::array<unsigned char, 4>& magic) {
        return std::equal(magic.begin(), magic.end(), bytes.begin(), [](unsigned char a, char b) {
            return a == static_cast<unsigned char>(b);
        });
    };
    return starts_with(png) ? ImageKind::Png : starts_with(exr) ? ImageKind::Exr : ImageKind::Other;
}

} // namespace

void check_image_size(const std::filesystem::path& file, std::uint64_t width,
                      std::uint64_t height) {
    constexpr std::uint64_t largest_side = 65536;
    if (width == 0 || height == 0 || width > largest_side || height > largest_side ||
        width * height > MAX_IMAGE_PIXELS)
        throw_input_error(
            {file.string()}, fmt::format("the image has {} x {} pixels", width, height),
            fmt::format("at most {} are read, no side over {}", MAX_IMAGE_PIXELS, largest_side));
}

int load_image(const std::string& name, const SourcePosition& at, ImageEncoding encoding,
               LoadState& state) {
    const std::filesystem::path file = state.resolve_and_digest(name, at);
    const ImageKind kind = kind_of(file);
    if (kind == ImageKind::Other)
        throw_input_error(at, fmt::format("\"{}\" is no image", name), "give a PNG or an EXR file");
    // A file may be colours in one place and data in another.
    const bool is_linear = encoding == ImageEncoding::Linear;
    for (std::size_t i = 0; i < state.images.size(); ++i)
        if (state.images[i].file == file && state.image_is_linear[i] == is_linear)
            return static_cast<int>(i);
    Image image =
        kind == ImageKind::Png ? read_png_image(file, encoding) : read_exr_image(file, encoding);
    image.file = file;
    state.images.push_back(std::move(image));
    state.image_is_linear.push_back(is_linear);
    return static_cast<int>(state.images.size()) - 1;
}

} // namespace reradiant
