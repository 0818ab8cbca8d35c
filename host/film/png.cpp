#include "host/film/png.h"

#include "host/base/atomic_file.h"
#include "reradiant/error.h"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace reradiant {

namespace {

void write_stream(std::FILE* stream, png_image& picture, const std::vector<std::uint8_t>& rgb) {
    constexpr int convert_to_8_bit = 0;
    constexpr int packed_rows = 0;
    const bool written = png_image_write_to_stdio(&picture, stream, convert_to_8_bit, rgb.data(),
                                                  packed_rows, nullptr) != 0;
    errno = 0;
    const bool closed = std::fclose(stream) == 0;
    if (!written)
        throw_runtime_error(picture.message);
    if (!closed)
        throw_runtime_error(std::strerror(errno));
}

} // namespace

void write_png(const std::filesystem::path& file, int width, int height,
               const std::vector<std::uint8_t>& rgb, bool is_srgb) {
    png_image picture{};
    picture.version = PNG_IMAGE_VERSION;
    picture.width = static_cast<png_uint_32>(width);
    picture.height = static_cast<png_uint_32>(height);
    picture.format = PNG_FORMAT_RGB;
    picture.flags = is_srgb ? 0u : static_cast<png_uint_32>(PNG_IMAGE_FLAG_COLORSPACE_NOT_sRGB);
    write_atomically(file, [&](const std::filesystem::path& target) {
        std::FILE* const stream = std::fopen(target.c_str(), "wb");
        if (!stream)
            throw_runtime_error(std::strerror(errno));
        write_stream(stream, picture, rgb);
    });
}

} // namespace reradiant
