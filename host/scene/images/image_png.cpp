#include "host/scene/images/image_io.h"

#include <png.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr std::size_t BYTES_PER_PIXEL = 6; // 16 bit RGB, big endian

struct Reader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::size_t packed_row_bytes = 0; ///< as the file has them
    std::string message;

    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    static_cast<Reader*>(png_get_error_ptr(png))->message = message;
    png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

// libpng leaves these two by longjmp: nothing in them may have a destructor.

bool read_header(Reader& reader, std::FILE* stream) {
    if (setjmp(png_jmpbuf(reader.png)))
        return false;
    png_init_io(reader.png, stream);
    png_read_info(reader.png, reader.info);
    reader.packed_row_bytes = png_get_rowbytes(reader.png, reader.info);
    png_set_expand_16(reader.png);
    png_set_gray_to_rgb(reader.png);
    png_set_strip_alpha(reader.png);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    return true;
}

bool read_pixels(Reader& reader, png_bytepp rows) {
    if (setjmp(png_jmpbuf(reader.png)))
        return false;
    png_read_image(reader.png, rows);
    png_read_end(reader.png, nullptr);
    return true;
}

/// IEC 61966-2-1.
float linear_from_srgb(float value) {
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

std::vector<float> table_of_values(ImageEncoding encoding) {
    std::vector<float> table(65536);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const float value = static_cast<float>(i) / 65535.0f;
        table[i] = encoding == ImageEncoding::Srgb ? linear_from_srgb(value) : value;
    }
    return table;
}

struct CloseFile {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
};

} // namespace

Image read_png_image(const std::filesystem::path& file, ImageEncoding encoding) {
    Reader reader;
    const auto refuse = [&] {
        throw_input_error({file.string()},
                          fmt::format("is no PNG file, or a damaged one ({})", reader.message),
                          "write it again");
    };
    const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "rb"));
    if (!stream)
        throw_input_error({file.string()}, "cannot be opened", "check its permissions");
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning);
    reader.info = reader.png != nullptr ? png_create_info_struct(reader.png) : nullptr;
    if (reader.info == nullptr)
        throw_runtime_error("libpng has no memory");
    if (!read_header(reader, stream.get()))
        refuse();
    Image image;
    const std::size_t width = png_get_image_width(reader.png, reader.info);
    const std::size_t height = png_get_image_height(reader.png, reader.info);
    check_image_size(file, width, height);
    constexpr std::size_t largest_zlib_ratio = 1032;
    if (reader.packed_row_bytes * height / largest_zlib_ratio > std::filesystem::file_size(file)) {
        reader.message = "its header promises more than it holds";
        refuse();
    }
    std::vector<unsigned char> bytes(width * height * BYTES_PER_PIXEL);
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y)
        rows[y] = bytes.data() + y * width * BYTES_PER_PIXEL;
    if (png_get_rowbytes(reader.png, reader.info) != width * BYTES_PER_PIXEL ||
        !read_pixels(reader, rows.data()))
        refuse();
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.rgb.resize(3 * width * height);
    const std::vector<float> values = table_of_values(encoding);
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        image.rgb[i] = values[bytes[2 * i] * std::size_t{256} + bytes[2 * i + 1]];
    return image;
}

} // namespace reradiant
