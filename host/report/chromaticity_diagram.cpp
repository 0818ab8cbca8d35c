#include "host/report/chromaticity_diagram.h"

#include "host/report/html.h"
#include "host/report/plot_frame.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

namespace reradiant::svg {

namespace {

constexpr double x_to = 0.8, y_to = 0.9, pixels_per_unit = 640;
constexpr double legend_row = 19;

Frame frame_of_diagram() {
    Frame frame;
    frame.width = x_to * pixels_per_unit;
    frame.height = y_to * pixels_per_unit;
    frame.x = make_axis(0.0, x_to, false, true);
    frame.y = make_axis(0.0, y_to, false, true);
    return frame;
}

bool is_finite(const Chromaticity& xy) {
    return std::isfinite(xy[0]) && std::isfinite(xy[1]);
}

std::string path_of(const Frame& frame, const std::vector<Chromaticity>& corners) {
    std::string path;
    for (const Chromaticity& xy : corners)
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', frame.x_of(xy[0]),
                            frame.y_of(xy[1]));
    return path + 'Z';
}

/// Wavelengths that are written at the locus: where they lie apart.
bool is_labelled(double nm) {
    const double tens = std::remainder(nm, 20.0);
    return std::abs(tens) < 1e-9 && ((nm >= 460.0 && nm <= 620.0) || nm == 700.0 || nm == 400.0);
}

std::string draw_locus(const Frame& frame, const ChromaticityDiagram& diagram) {
    std::string text = fmt::format("<path d=\"{}\" fill=\"#f4f4f4\" stroke=\"#444\"/>\n",
                                   path_of(frame, diagram.locus));
    const double middle_x = frame.x_of(1.0 / 3.0), middle_y = frame.y_of(1.0 / 3.0);
    for (std::size_t k = 0; k < diagram.nm.size(); ++k) {
        if (!is_labelled(diagram.nm[k]))
            continue;
        const double x = frame.x_of(diagram.locus[k][0]), y = frame.y_of(diagram.locus[k][1]);
        const double away_x = x - middle_x, away_y = y - middle_y;
        const double length = std::hypot(away_x, away_y);
        text +=
            fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.8\" fill=\"#444\"/>\n", x, y);
        text += text_at(x + 18 * away_x / length, y + 14 * away_y / length + 4, "middle",
                        fmt::format("{:g}", diagram.nm[k]), 10);
    }
    return text;
}

std::string draw_regions(const Frame& frame, const std::vector<ChromaticityRegion>& regions) {
    std::string text;
    for (const ChromaticityRegion& region : regions) {
        Chromaticity centre{};
        for (const Chromaticity& xy : region.corners)
            for (std::size_t c = 0; c < 2; ++c)
                centre[c] += xy[c] / static_cast<double>(region.corners.size());
        text += fmt::format("<path d=\"{}\" fill=\"#888\" fill-opacity=\"0.18\" stroke=\"#666\" "
                            "stroke-dasharray=\"4 2\"><title>{}</title></path>\n",
                            path_of(frame, region.corners), markup_escaped(region.name));
        text +=
            text_at(frame.x_of(centre[0]), frame.y_of(centre[1]) + 4, "middle", region.name, 10);
    }
    return text;
}

std::string draw_white(const Frame& frame, const Chromaticity& xy, std::size_t series) {
    if (!is_finite(xy))
        return {};
    return fmt::format("<path d=\"M{:.1f} {:.1f}h10m-5 -5v10\" stroke=\"{}\" "
                       "stroke-width=\"1.6\"/>\n",
                       frame.x_of(xy[0]) - 5, frame.y_of(xy[1]), series_colour(series));
}

std::string draw_point(const Frame& frame, const ChromaticityPoint& point) {
    if (!is_finite(point.xy))
        return {};
    const double x = frame.x_of(point.xy[0]), y = frame.y_of(point.xy[1]);
    const char* const colour = series_colour(point.series);
    std::string text;
    if (point.from && is_finite(*point.from)) {
        const double from_x = frame.x_of((*point.from)[0]), from_y = frame.y_of((*point.from)[1]);
        text += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"/>\n", from_x,
                            from_y, x, y, colour);
        text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"#fff\" "
                            "stroke=\"{}\"/>\n",
                            from_x, from_y, colour);
    }
    text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"><title>{}</title>"
                        "</circle>\n",
                        x, y, colour, markup_escaped(point.title));
    if (!point.mark.empty())
        text += text_at(x + 7, y - 5, "start", point.mark, 11);
    return text;
}

/// Names of the series, and what the marks stand for.
std::string draw_legend(const Frame& frame, const ChromaticityDiagram& diagram) {
    const double left = frame.right() + 20;
    double y = frame.top + 8;
    std::string text;
    for (std::size_t k = 0; k < diagram.series.size(); ++k) {
        text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", left, y,
                            series_colour(k));
        text += text_at(left + 12, y + 4, "start", diagram.series[k]);
        y += legend_row;
    }
    if (!diagram.whites.empty())
        text += text_at(left - 5, y + 4, "start", "+ white of the lamp");
    return text;
}

void check(const ChromaticityDiagram& diagram) {
    if (diagram.locus.size() != diagram.nm.size() || diagram.whites.size() > diagram.series.size())
        throw std::invalid_argument("a diagram needs a chromaticity for each wavelength of its "
                                    "locus, and a series for each white");
    for (const ChromaticityPoint& point : diagram.points)
        if (point.series >= diagram.series.size())
            throw std::invalid_argument("a point of the diagram is of no series");
}

double legend_width(const ChromaticityDiagram& diagram) {
    std::size_t longest = 20;
    for (const std::string& name : diagram.series)
        longest = std::max(longest, name.size());
    return 40.0 + 7.0 * static_cast<double>(longest);
}

} // namespace

std::string chromaticity_diagram(const ChromaticityDiagram& diagram) {
    check(diagram);
    const Frame frame = frame_of_diagram();
    std::string content = draw_frame(frame, diagram.title, diagram.x_label, diagram.y_label, true);
    content += draw_locus(frame, diagram);
    content += draw_regions(frame, diagram.regions);
    for (std::size_t k = 0; k < diagram.whites.size(); ++k)
        content += draw_white(frame, diagram.whites[k], k);
    for (const ChromaticityPoint& point : diagram.points)
        content += draw_point(frame, point);
    content += draw_legend(frame, diagram);
    return document(frame.right() + legend_width(diagram), frame.bottom() + 52, content);
}

} // namespace reradiant::svg
