#include "tools/commands/figure/figure_panels.h"

#include "host/film/colour_image.h"
#include "host/film/display/picture_levels.h"
#include "tools/program/groups_option.h"

#include <algorithm>

namespace reradiant {

namespace {

/// Errors about an image, which name its file, are placed where the figure names it.
template <typename Action>
auto placed_at(const SourcePosition& position, const Action& action) {
    try {
        return action();
    } catch (const Error& error) {
        throw_input_error(position, error.what());
    }
}

SpectralImage read(const ImageRequest& request) {
    return placed_at(request.light_factors.empty() ? request.position : request.light_position,
                     [&] { return read_image(request.file, request.light_factors); });
}

/// The exposure, EV, that suits all images whose exposure is shared: that of the brightest.
double shared_exposure(const FigureRequest& request) {
    double level = 0.0;
    for (const ImageRequest& image : request.images)
        if (image.has_shared_exposure)
            level = std::max(level, body_level(xyz_image(read(image))));
    return exposure_of_level(level);
}

/// The colours of the marks as the picture would show them: they are developed as it was.
void show_colours(ReadImage& image, const DevelopOptions& develop_options) {
    if (image.marks.empty())
        return;
    SpectralImage colours;
    colours.width = static_cast<int>(image.marks.size());
    colours.height = 1;
    colours.bands = image.bands;
    for (const ReadMark& mark : image.marks)
        for (const double radiance : mark.values.radiance)
            colours.values.push_back(static_cast<float>(radiance));
    DevelopOptions options = develop_options;
    options.auto_exposure = false;
    options.display.exposure_ev = image.picture.exposure_ev;
    options.auto_white = false;
    options.white_xy = image.picture.white_xy;
    const Picture shown = develop(colours, options);
    for (std::size_t k = 0; k < image.marks.size(); ++k)
        std::copy_n(shown.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(k), 3,
                    image.marks[k].rgb.begin());
}

ReadImage read_image(const ImageRequest& request, double shared_ev) {
    const SpectralImage image = read(request);
    DevelopOptions options = request.develop;
    if (request.has_shared_exposure)
        options.display.exposure_ev = shared_ev;
    ReadImage done;
    done.bands = image.bands;
    if (request.crop)
        placed_at(request.crop_position, [&] { return region_values(image, *request.crop); });
    for (const MarkRequest& mark : request.marks)
        done.marks.push_back(
            {placed_at(mark.position, [&] { return region_values(image, mark.region); })});
    done.picture = placed_at(request.position, [&] { return develop(image, options); });
    show_colours(done, options);
    return done;
}

} // namespace

std::vector<ReadImage> read_images(const FigureRequest& request) {
    const double shared_ev = shared_exposure(request);
    std::vector<ReadImage> images;
    for (const ImageRequest& image : request.images)
        images.push_back(read_image(image, shared_ev));
    return images;
}

} // namespace reradiant
