#include "host/film/display/jpeg.h"

#include "host/base/atomic_file.h"
#include "reradiant/error.h"

#include <csetjmp>
#include <cstdio> // what jpeglib.h leaves to its users
#include <cstdlib>
#include <jpeglib.h>
#include <memory>
#include <string>

namespace reradiant {

namespace {

constexpr int quality = 95;

/// What is written, and what libjpeg says against it. `errors` comes first: libjpeg knows it alone.
struct Writer {
    jpeg_error_mgr errors{};
    std::jmp_buf way_out;
    char message[JMSG_LENGTH_MAX] = "";
    unsigned char* bytes = nullptr;
    unsigned long count = 0;

    ~Writer() { std::free(bytes); }
};

[[noreturn]] void on_error(j_common_ptr common) {
    auto* const writer = reinterpret_cast<Writer*>(common->err);
    common->err->format_message(common, writer->message);
    std::longjmp(writer->way_out, 1);
}

/// libjpeg leaves this by longjmp: nothing in it may have a destructor.
bool write(Writer& writer, jpeg_compress_struct& jpeg, JDIMENSION width, JDIMENSION height,
           const std::uint8_t* rgb) {
    if (setjmp(writer.way_out))
        return false;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &writer.bytes, &writer.count);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < height) {
        JSAMPROW row =
            const_cast<JSAMPROW>(rgb + 3 * static_cast<std::size_t>(width) * jpeg.next_scanline);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
}

} // namespace

void write_jpeg(const std::filesystem::path& file, int width, int height,
                const std::vector<std::uint8_t>& rgb) {
    if (width > JPEG_MAX_DIMENSION || height > JPEG_MAX_DIMENSION)
        throw_input_error({file.string()}, "a JPEG has at most 65500 pixels a side",
                          "name a .png here");
    Writer writer;
    jpeg_compress_struct jpeg{};
    jpeg.err = jpeg_std_error(&writer.errors);
    writer.errors.error_exit = on_error;
    const bool written = write(writer, jpeg, static_cast<JDIMENSION>(width),
                               static_cast<JDIMENSION>(height), rgb.data());
    jpeg_destroy_compress(&jpeg);
    if (!written)
        throw_runtime_error("cannot write " + file.string() + ": " + writer.message);
    write_text_atomically(file,
                          std::string(reinterpret_cast<const char*>(writer.bytes), writer.count));
}

} // namespace reradiant
