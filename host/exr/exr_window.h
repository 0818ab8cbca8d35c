#pragma once

#include "reradiant/error.h"

#include <ImathBox.h>
#include <ImfHeader.h>

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace reradiant {

/// An `ExrWindow` says where the pixels of an EXR image lie. The image is the display window; a
/// file gives the pixels of the data window, which may be larger, smaller or elsewhere. What it
/// does not give is black.
struct ExrWindow {
    Imath::Box2i data, display;

    explicit ExrWindow(const Imf::Header& header)
        : data(header.dataWindow()), display(header.displayWindow()) {}

    std::int64_t width() const { return extent(display, 0); }
    std::int64_t height() const { return extent(display, 1); }
    std::int64_t data_width() const { return extent(data, 0); }
    std::int64_t data_height() const { return extent(data, 1); }
    std::size_t pixels() const { return static_cast<std::size_t>(width() * height()); }
    std::size_t data_pixels() const {
        return static_cast<std::size_t>(data_width() * data_height());
    }

private:
    static std::int64_t extent(const Imath::Box2i& box, int axis) {
        return std::int64_t{box.max[axis]} - box.min[axis] + 1;
    }
};

/// Input Error for a display window beyond a film's 65536, or one that takes far more memory than
/// the file could fill: `floats` for each pixel.
inline void check_display_window(const std::filesystem::path& file, const ExrWindow& window,
                                 std::size_t floats) {
    constexpr std::int64_t largest_side = 65536;
    constexpr double free_bytes = 128.0 * (1 << 20), most_ratio = 4000.0;
    std::error_code ignored;
    const double size = static_cast<double>(std::filesystem::file_size(file, ignored));
    const double bytes = static_cast<double>(window.width()) *
                         static_cast<double>(window.height()) * static_cast<double>(floats) *
                         sizeof(float);
    const bool is_larger =
        window.width() > window.data_width() || window.height() > window.data_height();
    if (window.width() > largest_side || window.height() > largest_side ||
        (is_larger && bytes > free_bytes + most_ratio * size))
        throw_input_error({file.string()},
                          fmt::format("its display window has {} x {} pixels, its data {} x {}",
                                      window.width(), window.height(), window.data_width(),
                                      window.data_height()),
                          "crop the display window to the image");
}

/// The display window's values of an image that was read as its data window: (height, width,
/// channels), zero outside the data.
inline std::vector<float> fit_to_display(std::vector<float> values, const ExrWindow& window,
                                         std::size_t channels) {
    if (window.data == window.display || values.empty())
        return values;
    std::vector<float> fitted(window.pixels() * channels, 0.0f);
    const std::int64_t left = std::max(window.data.min.x, window.display.min.x);
    const std::int64_t right = std::min(window.data.max.x, window.display.max.x);
    const std::int64_t top = std::max(window.data.min.y, window.display.min.y);
    const std::int64_t bottom = std::min(window.data.max.y, window.display.max.y);
    const auto place = [&](const Imath::Box2i& box, std::int64_t width, std::int64_t y) {
        return static_cast<std::ptrdiff_t>((y - box.min.y) * width + left - box.min.x) *
               static_cast<std::ptrdiff_t>(channels);
    };
    for (std::int64_t y = top; y <= bottom && left <= right; ++y)
        std::copy_n(values.begin() + place(window.data, window.data_width(), y),
                    static_cast<std::size_t>(right - left + 1) * channels,
                    fitted.begin() + place(window.display, window.width(), y));
    return fitted;
}

} // namespace reradiant
