#include "host/film/display/tiff.h"

#include "host/base/atomic_file.h"
#include "reradiant/error.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <tiffio.h>

namespace reradiant {

namespace {

/// The file while libtiff writes it: it goes back to its start for the place of its directory.
struct Bytes {
    std::string bytes;
    std::size_t place = 0;
};

tmsize_t on_read(thandle_t, void*, tmsize_t) {
    return 0;
}
/// No exception may pass through libtiff: a count that is too small is an error to it.
tmsize_t on_write(thandle_t handle, void* data, tmsize_t count) noexcept try {
    auto& file = *static_cast<Bytes*>(handle);
    const std::size_t end = file.place + static_cast<std::size_t>(count);
    file.bytes.resize(std::max(file.bytes.size(), end));
    std::copy_n(static_cast<const char*>(data), count, file.bytes.data() + file.place);
    file.place = end;
    return count;
} catch (const std::bad_alloc&) {
    return 0;
}
toff_t on_seek(thandle_t handle, toff_t offset, int whence) {
    auto& file = *static_cast<Bytes*>(handle);
    const std::size_t from = whence == SEEK_SET   ? 0
                             : whence == SEEK_CUR ? file.place
                                                  : file.bytes.size();
    file.place = from + offset;
    return file.place;
}
int on_close(thandle_t) {
    return 0;
}
toff_t on_size(thandle_t handle) {
    return static_cast<Bytes*>(handle)->bytes.size();
}

/// Sets what a reader must know; true where libtiff took it.
bool describe(TIFF* tiff, std::uint32_t width, std::uint32_t height) {
    return TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width) &&
           TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height) &&
           TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 3) &&
           TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8) &&
           TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB) &&
           TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
           TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW) &&
           TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL) &&
           TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
}

bool write_rows(TIFF* tiff, std::uint32_t width, std::uint32_t height,
                const std::vector<std::uint8_t>& rgb) {
    std::vector<std::uint8_t> row(3 * std::size_t{width}); // the predictor changes what it is given
    for (std::uint32_t y = 0; y < height; ++y) {
        std::copy_n(rgb.data() + row.size() * y, row.size(), row.data());
        if (TIFFWriteScanline(tiff, row.data(), y, 0) != 1)
            return false;
    }
    return TIFFFlush(tiff) == 1;
}

} // namespace

void write_tiff(const std::filesystem::path& file, int width, int height,
                const std::vector<std::uint8_t>& rgb) {
    const auto columns = static_cast<std::uint32_t>(width);
    const auto rows = static_cast<std::uint32_t>(height);
    Bytes bytes;
    bool written = false;
    {
        const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(
            TIFFClientOpen(file.c_str(), "w", &bytes, on_read, on_write, on_seek, on_close, on_size,
                           nullptr, nullptr),
            TIFFClose);
        written = tiff && describe(tiff.get(), columns, rows) &&
                  write_rows(tiff.get(), columns, rows, rgb);
    }
    if (!written)
        throw_runtime_error("cannot write " + file.string() + ": libtiff refuses the picture");
    write_text_atomically(file, bytes.bytes);
}

} // namespace reradiant
