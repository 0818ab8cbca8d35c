#include "tools/commands/figure/figure_panels.h"

#include "reradiant/colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

/// Makes panels of what was asked for and of what was read for it.
class PanelMaker {
public:
    PanelMaker(const FigureRequest& request, const std::vector<ReadImage>& images)
        : request_(request), images_(images) {
        for (const ReadImage& image : images)
            exposures_differ_ = exposures_differ_ ||
                                image.picture.exposure_ev != images.front().picture.exposure_ev;
    }

    FigurePanel panel(const PanelReference& reference) const {
        switch (reference.kind) {
        case PanelReference::Kind::Plot:
            return plot_panel(request_.plots[reference.index]);
        case PanelReference::Kind::Swatches:
            return swatch_panel(request_.swatches[reference.index]);
        case PanelReference::Kind::Image:
            break;
        }
        return picture_panel(reference.index);
    }

private:
    FigurePanel picture_panel(std::size_t index) const;
    FigurePanel plot_panel(const PlotRequest& plot) const;
    FigurePanel swatch_panel(const SwatchRequest& swatches) const;
    svg::Series series_of(const MarkReference& reference, const PlotRequest& plot) const;

    const ReadMark& read(const MarkReference& reference) const {
        return images_[reference.image].marks[reference.mark];
    }
    /// Marks have colours in the order in which the file names them.
    std::size_t colour_of(const MarkReference& reference) const {
        std::size_t colour = reference.mark;
        for (std::size_t image = 0; image < reference.image; ++image)
            colour += images_[image].marks.size();
        return colour;
    }
    /// A label that tells marks of different images apart.
    std::string label_of(const MarkReference& reference,
                         const std::vector<MarkReference>& all) const;

    const FigureRequest& request_;
    const std::vector<ReadImage>& images_;
    bool exposures_differ_ = false;
};

Picture cropped(const Picture& picture, const ImageRegion& crop) {
    Picture part = picture;
    part.width = crop.x1 - crop.x0 + 1;
    part.height = crop.y1 - crop.y0 + 1;
    part.rgb.clear();
    for (int y = crop.y0; y <= crop.y1; ++y) {
        const auto row = picture.rgb.begin() + 3 * (std::ptrdiff_t{y} * picture.width + crop.x0);
        part.rgb.insert(part.rgb.end(), row, row + 3 * std::ptrdiff_t{part.width});
    }
    return part;
}

FigureMark mark_of(const MarkRequest& mark, std::size_t colour) {
    const ImageRegion& region = mark.region;
    return {.label = mark.label,
            .colour = colour,
            .x = 0.5 * (region.x0 + region.x1 + 1),
            .y = 0.5 * (region.y0 + region.y1 + 1),
            .half_width = 0.5 * (region.x1 - region.x0 + 1),
            .half_height = 0.5 * (region.y1 - region.y0 + 1),
            .is_round = region.radius > 0.0 || region.x0 == region.x1};
}

FigurePanel PanelMaker::picture_panel(std::size_t index) const {
    const ImageRequest& image = request_.images[index];
    const Picture& whole = images_[index].picture;
    ImageRegion shown = image.crop.value_or(ImageRegion());
    if (!image.crop) {
        shown.x1 = whole.width - 1;
        shown.y1 = whole.height - 1;
    }
    PicturePanel panel{.picture = cropped(whole, shown)};
    for (std::size_t k = 0; k < image.marks.size(); ++k) {
        FigureMark mark = mark_of(image.marks[k], colour_of({index, k}));
        mark.x -= shown.x0;
        mark.y -= shown.y0;
        if (mark.x > 0 && mark.y > 0 && mark.x < panel.picture.width &&
            mark.y < panel.picture.height)
            panel.marks.push_back(std::move(mark));
    }
    if (exposures_differ_)
        panel.note = fmt::format("{:+.3g} EV", whole.exposure_ev);
    return {.title = image.title, .content = std::move(panel)};
}

std::string PanelMaker::label_of(const MarkReference& reference,
                                 const std::vector<MarkReference>& all) const {
    const MarkRequest& mark = request_.mark(reference);
    const bool is_shared = std::any_of(all.begin(), all.end(), [&](const MarkReference& other) {
        return other.image != reference.image && request_.mark(other).label == mark.label;
    });
    if (!is_shared)
        return mark.label;
    const ImageRequest& image = request_.images[reference.image];
    return fmt::format("{}, {}", mark.label, image.title.empty() ? image.name : image.title);
}

svg::Series PanelMaker::series_of(const MarkReference& reference, const PlotRequest& plot) const {
    constexpr double quantile = 1.96; // 95 % of a normal distribution
    const RegionValues& values = read(reference).values;
    const std::vector<double> nm = images_[reference.image].bands.centres_nm();
    svg::Series series{
        .label = label_of(reference, plot.marks), .x = {}, .y = {}, .colour = colour_of(reference)};
    for (std::size_t band = 0; band < nm.size(); ++band) {
        if (nm[band] < plot.from_nm || nm[band] > plot.to_nm)
            continue;
        ValueRatio value{values.radiance[band], values.radiance_stderr[band]};
        if (plot.against) {
            const RegionValues& below = read(*plot.against).values;
            value = ratio_of(value.value, value.standard_error, below.radiance[band],
                             below.radiance_stderr[band]);
        }
        series.x.push_back(nm[band]);
        series.y.push_back(value.value);
        series.low.push_back(value.value - quantile * value.standard_error);
        series.high.push_back(value.value + quantile * value.standard_error);
    }
    return series;
}

FigurePanel PanelMaker::plot_panel(const PlotRequest& plot) const {
    PlotPanel panel;
    panel.axes.x_label = "wavelength / nm";
    panel.axes.y_label = "radiance / W m⁻² sr⁻¹ nm⁻¹";
    if (plot.against)
        panel.axes.y_label = "ratio to " + label_of(*plot.against, plot.marks);
    panel.axes.log_y = plot.is_logarithmic;
    for (const MarkReference& reference : plot.marks)
        panel.series.push_back(series_of(reference, plot));
    return {.title = plot.title, .content = std::move(panel), .aspect = plot.aspect};
}

FigurePanel PanelMaker::swatch_panel(const SwatchRequest& swatches) const {
    SwatchPanel panel;
    for (const MarkReference& reference : swatches.marks) {
        const ReadMark& mark = read(reference);
        const auto lab = xyz_to_lab(mark.values.xyz, swatches.white);
        Swatch swatch{.label = label_of(reference, swatches.marks), .values = {}, .rgb = mark.rgb};
        swatch.values.push_back(
            fmt::format("L* {:.1f}  a* {:.1f}  b* {:.1f}", lab[0], lab[1], lab[2]));
        if (swatches.against)
            swatch.values.push_back(fmt::format(
                "ΔE₀₀ {:.1f}",
                ciede2000(xyz_to_lab(read(*swatches.against).values.xyz, swatches.white), lab)));
        panel.swatches.push_back(std::move(swatch));
    }
    return {.title = swatches.title, .content = std::move(panel), .aspect = swatches.aspect};
}

} // namespace

Figure figure_of(const FigureRequest& request, const std::vector<ReadImage>& images) {
    const PanelMaker maker(request, images);
    Figure figure = request.page;
    for (const auto& row : request.rows) {
        figure.rows.emplace_back();
        for (const PanelReference& reference : row)
            figure.rows.back().push_back(maker.panel(reference));
    }
    return figure;
}

} // namespace reradiant
