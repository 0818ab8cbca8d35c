#include "host/film/display/png.h"

#include "host/base/atomic_file.h"
#include "reradiant/error.h"

#include <png.h>

#include <new>
#include <string>
#include <utility>

namespace reradiant {

namespace {

/// What is written, and what libpng says against it.
struct Writer {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string bytes, message;

    ~Writer() { png_destroy_write_struct(&png, &info); }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    static_cast<Writer*>(png_get_error_ptr(png))->message = message;
    png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

bool append(std::string& bytes, png_const_bytep added, std::size_t count) noexcept {
    try {
        bytes.append(reinterpret_cast<const char*>(added), count);
        return true;
    } catch (const std::bad_alloc&) {
        return false;
    }
}

void on_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    if (!append(static_cast<Writer*>(png_get_io_ptr(png))->bytes, bytes, count))
        png_error(png, "out of memory");
}
void on_flush(png_structp) {}

/// libpng 1.6 of older distributions has no function for this chunk.
void set_cicp(Writer& writer, const PictureEncoding& encoding) {
    constexpr png_byte rgb_matrix = 0, full_range = 1;
    png_byte data[] = {encoding.cicp_primaries, encoding.cicp_transfer, rgb_matrix, full_range};
    png_unknown_chunk chunk{};
    const char name[] = "cICP";
    for (std::size_t k = 0; k < sizeof name; ++k)
        chunk.name[k] = static_cast<png_byte>(name[k]);
    chunk.data = data;
    chunk.size = sizeof data;
    chunk.location = PNG_HAVE_IHDR;
    png_set_keep_unknown_chunks(writer.png, PNG_HANDLE_CHUNK_ALWAYS, chunk.name, 1);
    png_set_unknown_chunks(writer.png, writer.info, &chunk, 1);
}

void set_colours(Writer& writer, const PictureEncoding& encoding) {
    if (encoding.is_srgb) {
        png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
        return;
    }
    if (encoding.cicp_transfer != 0)
        set_cicp(writer, encoding);
    if (encoding.gamma > 0.0 && encoding.primaries_xy) {
        const auto& xy = *encoding.primaries_xy;
        png_set_gAMA(writer.png, writer.info, 1.0 / encoding.gamma);
        png_set_cHRM(writer.png, writer.info, xy[0][0], xy[0][1], xy[1][0], xy[1][1], xy[2][0],
                     xy[2][1], xy[3][0], xy[3][1]);
    }
}

/// libpng leaves this by longjmp: nothing in it may have a destructor.
bool write(Writer& writer, png_uint_32 width, png_uint_32 height, png_const_bytep rgb,
           const PictureEncoding& encoding) {
    if (setjmp(png_jmpbuf(writer.png)))
        return false;
    constexpr int bits = 8;
    png_set_write_fn(writer.png, &writer, on_bytes, on_flush);
    png_set_IHDR(writer.png, writer.info, width, height, bits, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    set_colours(writer, encoding);
    png_write_info(writer.png, writer.info);
    for (png_uint_32 row = 0; row < height; ++row)
        png_write_row(writer.png, rgb + 3 * static_cast<std::size_t>(width) * row);
    png_write_end(writer.png, nullptr);
    return true;
}

} // namespace

std::string png_bytes(int width, int height, const std::vector<std::uint8_t>& rgb,
                      const PictureEncoding& encoding) {
    Writer writer;
    writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_error, on_warning);
    writer.info = writer.png ? png_create_info_struct(writer.png) : nullptr;
    if (!writer.info)
        throw std::bad_alloc();
    if (!write(writer, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
               rgb.data(), encoding))
        throw_runtime_error("a PNG cannot be made: " + writer.message);
    return std::move(writer.bytes);
}

void write_png(const std::filesystem::path& file, int width, int height,
               const std::vector<std::uint8_t>& rgb, const PictureEncoding& encoding) {
    write_text_atomically(file, png_bytes(width, height, rgb, encoding));
}

void write_png(const std::filesystem::path& file, int width, int height,
               const std::vector<std::uint8_t>& rgb, bool is_srgb) {
    PictureEncoding encoding;
    encoding.is_srgb = is_srgb;
    write_png(file, width, height, rgb, encoding);
}

} // namespace reradiant
