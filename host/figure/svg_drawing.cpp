#include "host/figure/svg_drawing.h"

#include "reradiant/error.h"

#include <cairo/cairo-pdf.h>
#include <cairo/cairo-svg.h>
#include <cairo/cairo.h>
#include <fmt/core.h>
#include <librsvg/rsvg.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

namespace reradiant {

namespace {

struct Deleter {
    void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
    void operator()(GInputStream* stream) const { g_object_unref(stream); }
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Handle = std::unique_ptr<RsvgHandle, Deleter>;
using Stream = std::unique_ptr<GInputStream, Deleter>;
using Surface = std::unique_ptr<cairo_surface_t, Deleter>;
using Context = std::unique_ptr<cairo_t, Deleter>;

[[noreturn]] void fail(const std::string& reason) {
    throw_runtime_error("a drawing cannot be made: " + reason);
}

[[noreturn]] void fail(GError* error) {
    const std::string reason = error ? error->message : "the library does not say why";
    g_clear_error(&error);
    fail(reason);
}

void check(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS)
        fail(cairo_status_to_string(status));
}

/// Pictures within the text make it larger than what a parser takes from strangers.
Handle parsed(const std::string& svg) {
    GError* error = nullptr;
    const Stream stream(
        g_memory_input_stream_new_from_data(svg.data(), static_cast<gssize>(svg.size()), nullptr));
    Handle handle(rsvg_handle_new_from_stream_sync(stream.get(), nullptr,
                                                   RSVG_HANDLE_FLAG_UNLIMITED, nullptr, &error));
    if (!handle)
        fail(error);
    return handle;
}

struct Size {
    double width = 0.0, height = 0.0; ///< points
};

Size size_of(const Handle& handle) {
    gboolean has_width = FALSE;
    gboolean has_height = FALSE;
    gboolean has_box = FALSE;
    RsvgRectangle box{};
    rsvg_handle_get_intrinsic_dimensions(handle.get(), &has_width, nullptr, &has_height, nullptr,
                                         &has_box, &box);
    if (!has_box)
        fail("its size is not said");
    return {box.width, box.height};
}

void draw(const Handle& handle, cairo_surface_t* surface, double width, double height) {
    const Context context(cairo_create(surface));
    const RsvgRectangle viewport{0.0, 0.0, width, height};
    GError* error = nullptr;
    if (!rsvg_handle_render_document(handle.get(), context.get(), &viewport, &error))
        fail(error);
    check(cairo_status(context.get()));
}

/// No exception may pass through cairo.
cairo_status_t append(void* bytes, const unsigned char* added, unsigned count) noexcept try {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(added), count);
    return CAIRO_STATUS_SUCCESS;
} catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
}

/// Draws on a surface that writes what is drawn into the string.
void finish(const Handle& handle, const Surface& surface, const Size& size) {
    check(cairo_surface_status(surface.get()));
    draw(handle, surface.get(), size.width, size.height);
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
}

/// Makes a surface white.
void whiten(cairo_surface_t* surface) {
    const Context context(cairo_create(surface));
    cairo_set_source_rgb(context.get(), 1.0, 1.0, 1.0);
    cairo_paint(context.get());
}

/// The three colours of a surface's pixels, which have four bytes each.
std::vector<std::uint8_t> colours_of(cairo_surface_t* surface, int width, int height) {
    cairo_surface_flush(surface);
    const unsigned char* row = cairo_image_surface_get_data(surface);
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y, row += cairo_image_surface_get_stride(surface))
        for (int x = 0; x < width; ++x) {
            const std::uint32_t pixel = reinterpret_cast<const std::uint32_t*>(row)[x];
            for (const int shift : {16, 8, 0})
                rgb.push_back(static_cast<std::uint8_t>(pixel >> shift));
        }
    return rgb;
}

} // namespace

std::string svg_with_outlines(const std::string& svg) {
    const Handle handle = parsed(svg);
    const Size size = size_of(handle);
    std::string bytes;
    {
        const Surface surface(
            cairo_svg_surface_create_for_stream(append, &bytes, size.width, size.height));
        finish(handle, surface, size);
    }
    return bytes;
}

std::string pdf_of_svg(const std::string& svg) {
    const Handle handle = parsed(svg);
    const Size size = size_of(handle);
    std::string bytes;
    {
        const Surface surface(
            cairo_pdf_surface_create_for_stream(append, &bytes, size.width, size.height));
        // The same figure is the same file on every day.
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                       "2000-01-01T00:00:00Z");
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "Reradiant");
        finish(handle, surface, size);
    }
    return bytes;
}

Picture picture_of_svg(const std::string& svg, double dpi) {
    const Handle handle = parsed(svg);
    const Size size = size_of(handle);
    const auto pixels = [dpi](double points) {
        return static_cast<int>(
            std::clamp(std::round(points * dpi / 72.0), 1.0, 2.0 * largest_drawing_side));
    };
    Picture picture;
    picture.width = pixels(size.width);
    picture.height = pixels(size.height);
    picture.encoding.is_srgb = true;
    if (std::max(picture.width, picture.height) > largest_drawing_side)
        fail(fmt::format("it would have more than {} pixels a side", largest_drawing_side));
    const Surface surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height));
    check(cairo_surface_status(surface.get()));
    // Paper also where a drawing's edge lies within a pixel.
    whiten(surface.get());
    draw(handle, surface.get(), picture.width, picture.height);
    picture.rgb = colours_of(surface.get(), picture.width, picture.height);
    return picture;
}

double text_width(const std::string& text, bool is_bold) {
    constexpr double size = 100.0; // large, so that hinting rounds nothing
    const Surface surface(cairo_recording_surface_create(CAIRO_CONTENT_ALPHA, nullptr));
    const Context context(cairo_create(surface.get()));
    cairo_select_font_face(context.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           is_bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context.get(), size);
    cairo_text_extents_t extents{};
    cairo_text_extents(context.get(), text.c_str(), &extents);
    check(cairo_status(context.get()));
    return extents.x_advance / size;
}

} // namespace reradiant
