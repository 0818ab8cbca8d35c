#include "host/report/chromaticity_diagram.h"

#include "host/report/html.h"
#include "host/report/plot_frame.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

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
    return std::abs(tens) < 1e-9 && ((nm >= 460.0 && nm <= 620.0) || nm == 700.0);
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

Chromaticity middle_of(const std::vector<Chromaticity>& corners) {
    Chromaticity middle{};
    for (const Chromaticity& xy : corners)
        for (std::size_t c = 0; c < 2; ++c)
            middle[c] += xy[c] / static_cast<double>(corners.size());
    return middle;
}

/// True where a ray from the point towards +x crosses the outline an odd number of times.
bool is_inside(const Chromaticity& xy, const std::vector<Chromaticity>& outline) {
    bool inside = false;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const Chromaticity &a = outline[k], &b = outline[(k + 1) % outline.size()];
        if ((a[1] > xy[1]) != (b[1] > xy[1]) &&
            xy[0] < a[0] + (xy[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside;
}

/// Goes on from a region, away from the middle of the diagram, to where no colours are.
Chromaticity beyond_locus(Chromaticity xy, const std::vector<Chromaticity>& locus) {
    constexpr double step = 0.01, clearance = 0.03;
    const Chromaticity away{xy[0] - 1.0 / 3.0, xy[1] - 1.0 / 3.0};
    const double length = std::max(1e-6, std::hypot(away[0], away[1]));
    const auto go = [&](double distance) {
        for (std::size_t c = 0; c < 2; ++c)
            xy[c] += distance * away[c] / length;
    };
    for (int k = 0; k < 100 && is_inside(xy, locus); ++k)
        go(step);
    go(clearance);
    return xy;
}

std::string draw_regions(const Frame& frame, const ChromaticityDiagram& diagram) {
    std::string text;
    double lowest = frame.top; // names of regions stand below each other
    std::vector<std::pair<Chromaticity, const ChromaticityRegion*>> names;
    for (const ChromaticityRegion& region : diagram.regions)
        names.emplace_back(beyond_locus(middle_of(region.corners), diagram.locus), &region);
    std::sort(names.begin(), names.end(),
              [](const auto& a, const auto& b) { return a.first[1] > b.first[1]; });
    for (const auto& [place, region] : names) {
        const Chromaticity middle = middle_of(region->corners);
        const double y = std::max(lowest + 14, frame.y_of(place[1]));
        double x = frame.x_of(place[0]);
        if (x + 7.0 * static_cast<double>(region->name.size()) > frame.right())
            x = frame.right() + 14; // the border would cross the name
        text += fmt::format("<path d=\"{}\" fill=\"#888\" fill-opacity=\"0.18\" stroke=\"#666\" "
                            "stroke-dasharray=\"4 2\"/>\n",
                            path_of(frame, region->corners));
        text += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#999\"/>\n",
                            frame.x_of(middle[0]), frame.y_of(middle[1]), x, y);
        text += text_at(x + 4, y + 4, "start", region->name, 11);
        lowest = y;
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
    for (const ChromaticityRegion& region : diagram.regions)
        longest = std::max(longest, region.name.size());
    return 40.0 + 7.0 * static_cast<double>(longest);
}

} // namespace

std::string chromaticity_diagram(const ChromaticityDiagram& diagram) {
    check(diagram);
    const Frame frame = frame_of_diagram();
    std::string content = draw_frame(frame, diagram.title, diagram.x_label, diagram.y_label, true);
    content += draw_locus(frame, diagram);
    content += draw_regions(frame, diagram);
    for (std::size_t k = 0; k < diagram.whites.size(); ++k)
        content += draw_white(frame, diagram.whites[k], k);
    for (const ChromaticityPoint& point : diagram.points)
        content += draw_point(frame, point);
    content += draw_legend(frame, diagram);
    return document(frame.right() + legend_width(diagram), frame.bottom() + 52, content);
}

} // namespace reradiant::svg
