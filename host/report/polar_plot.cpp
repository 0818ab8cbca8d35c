#include "host/report/polar_plot.h"

#include "host/report/plot_frame.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace reradiant::svg {

namespace {

constexpr std::array colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7"};
constexpr double radius = 190, centre_x = 240, centre_y = 240;
constexpr int decades = 4;

struct Point {
    double x, y;
};

Point at(double angle_deg, double share) {
    const double angle = angle_deg * std::numbers::pi / 180.0;
    return {centre_x + radius * share * std::sin(angle),
            centre_y - radius * share * std::cos(angle)};
}

/// Exponent of the power of ten at the rim.
int rim_exponent(const std::vector<PolarSeries>& series) {
    double largest = 0.0;
    for (const PolarSeries& one : series)
        for (const double value : one.value)
            if (std::isfinite(value) && value > largest)
                largest = value;
    return largest > 0.0 ? static_cast<int>(std::ceil(std::log10(largest) - 1e-9)) : 0;
}

/// True when some curve has a side beneath the surface.
bool has_far_side(const std::vector<PolarSeries>& series) {
    return std::any_of(series.begin(), series.end(), [](const PolarSeries& one) {
        return std::any_of(one.angle_deg.begin(), one.angle_deg.end(),
                           [](double angle) { return std::abs(angle) > 90.0; });
    });
}

/// Half a circle from one end of the surface to the other.
std::string draw_arc(double from_deg, double share) {
    const Point from = at(from_deg, share), to = at(-from_deg, share);
    return fmt::format("<path d=\"M{:.1f} {:.1f}A{:.1f} {:.1f} 0 0 1 {:.1f} {:.1f}\" "
                       "fill=\"none\" stroke=\"{}\"/>\n",
                       from.x, from.y, radius * share, radius * share, to.x, to.y,
                       share == 1.0 ? "#444" : "#ddd");
}

std::string draw_grid(int rim, bool whole_circle) {
    std::string grid;
    for (int decade = 1; decade <= decades; ++decade) {
        const double share = static_cast<double>(decade) / decades;
        const Point right = at(90, share);
        grid += draw_arc(-90, share) + (whole_circle ? draw_arc(90, share) : "");
        grid += text_at(right.x, right.y + 16, "middle",
                        number_label(std::pow(10.0, rim - decades + decade)), 11);
    }
    const int last = whole_circle ? 180 : 90;
    for (int angle = whole_circle ? -150 : -90; angle <= last; angle += 30) {
        const Point end = at(angle, 1.0), label = at(angle, 1.08);
        grid += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#ddd\"/>\n",
                            centre_x, centre_y, end.x, end.y);
        if (std::abs(angle) != 90)
            grid += text_at(label.x, label.y + 4, "middle", fmt::format("{}\u00b0", angle), 11);
    }
    return grid;
}

std::string draw_curve(const PolarSeries& series, int rim, std::size_t index) {
    std::string path;
    bool drawing = false;
    for (std::size_t k = 0; k < series.value.size(); ++k) {
        const double share = 1.0 + (std::log10(series.value[k]) - rim) / decades;
        if (!(share > 0.0) || !std::isfinite(share)) { // NaN and 0, too
            drawing = false;
            continue;
        }
        const Point point = at(series.angle_deg[k], share);
        path += fmt::format("{}{:.1f} {:.1f}", drawing ? 'L' : 'M', point.x, point.y);
        drawing = true;
    }
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"/>\n", path,
                       colours[index % colours.size()]);
}

std::string draw_arrow(double angle_deg) {
    const Point from = at(-angle_deg, 1.0), to = at(-angle_deg, 0.82);
    return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#222\" "
                       "stroke-width=\"3\"/><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" "
                       "fill=\"#222\"/>\n",
                       from.x, from.y, to.x, to.y, to.x, to.y);
}

} // namespace

std::string polar_plot(const std::string& title, const std::vector<PolarSeries>& series,
                       double marked_deg) {
    const int rim = rim_exponent(series);
    const bool whole_circle = has_far_side(series);
    const double below = centre_y + (whole_circle ? radius + 24 : 0);
    std::string content = text_at(centre_x, 20, "middle", title, 14) + draw_grid(rim, whole_circle);
    for (std::size_t k = 0; k < series.size(); ++k) {
        if (series[k].angle_deg.size() != series[k].value.size())
            throw std::invalid_argument(fmt::format("polar series '{}' has {} angles and {} values",
                                                    series[k].label, series[k].angle_deg.size(),
                                                    series[k].value.size()));
        content += draw_curve(series[k], rim, k);
        const double y = below + 38 + 18 * static_cast<double>(k);
        content += fmt::format("<path d=\"M60 {:.1f}h24\" stroke=\"{}\" stroke-width=\"1.8\"/>\n",
                               y, colours[k % colours.size()]);
        content += text_at(92, y + 4, "start", series[k].label);
    }
    content += draw_arrow(marked_deg);
    return document(2 * centre_x, below + 46 + 18 * static_cast<double>(series.size()), content);
}

} // namespace reradiant::svg
