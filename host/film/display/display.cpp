#include "host/film/display/display_picture.h"

#include "reradiant/error.h"

#include <fmt/core.h>

#include <cmath>

namespace reradiant {

namespace {

DevelopOptions plainly(const DisplayOptions& options) {
    DevelopOptions plain;
    plain.display = options;
    return plain;
}

} // namespace

void check_exposure(double exposure_ev) {
    constexpr double most_ev = 100.0;
    if (!(std::abs(exposure_ev) <= most_ev))
        throw_input_error({}, fmt::format("--exposure is {}", exposure_ev),
                          fmt::format("it must be from {} to {}", -most_ev, most_ev));
}

void check_display(const DisplayOptions& options) {
    check_develop(plainly(options));
}

Picture display_picture(const SpectralImage& image, const DisplayOptions& options) {
    return develop(image, plainly(options));
}

std::size_t write_display_png(const std::filesystem::path& file, const SpectralImage& image,
                              const DisplayOptions& options) {
    const Picture picture = display_picture(image, options);
    write_picture(file, picture);
    return picture.out_of_gamut;
}

} // namespace reradiant
