#include "host/report/plot_frame.h"
#include "host/report/svg.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace reradiant::svg {

namespace {

/// When the colours are used up the lines change their dashes.
constexpr std::array dashes = {"", "6 3", "2 3", "8 3 2 3"};

/// Which colour and dashes a series has.
std::size_t look_of(const std::vector<Series>& series, std::size_t place) {
    return series[place].colour.value_or(place);
}

std::string dashes_of(std::size_t index) {
    const char* const pattern = dashes[index / series_colours % dashes.size()];
    return *pattern ? fmt::format(" stroke-dasharray=\"{}\"", pattern) : "";
}

bool can_be_drawn(double value, bool is_log) {
    return std::isfinite(value) && (!is_log || value > 0.0);
}

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void include(const std::vector<double>& values, bool is_log) {
        for (const double value : values)
            if (can_be_drawn(value, is_log)) {
                low = std::min(low, value);
                high = std::max(high, value);
            }
    }
    Axis axis(bool is_log, bool exact) const {
        return low <= high ? make_axis(low, high, is_log, exact)
                           : make_axis(is_log ? 0.1 : 0.0, 1.0, is_log, exact);
    }
};

void check(const Series& series) {
    const std::size_t count = series.x.size();
    const auto fits = [count](const std::vector<double>& band) {
        return band.empty() || band.size() == count;
    };
    if (series.y.size() != count || !fits(series.low) || !fits(series.high) ||
        series.low.empty() != series.high.empty())
        throw std::invalid_argument(fmt::format(
            "series '{}' has {} x, {} y and a band of {} and {} values; they must be equally many",
            series.label, count, series.y.size(), series.low.size(), series.high.size()));
}

Frame frame_of(const Axes& axes, const std::vector<Series>& series) {
    Range x, y;
    for (const Series& one : series) {
        x.include(one.x, axes.log_x);
        for (const std::vector<double>* values : {&one.y, &one.low, &one.high})
            y.include(*values, axes.log_y);
    }
    Frame frame;
    frame.x = x.axis(axes.log_x, true);
    frame.y = y.axis(axes.log_y, false);
    return frame;
}

/// One step of a path: M moves, L draws.
std::string step(const Frame& frame, char command, double x, double y) {
    return fmt::format("{}{:.1f} {:.1f}", command, frame.x_of(x), frame.y_of(y));
}

/// Indices in runs whose x and values can all be drawn.
std::vector<std::vector<std::size_t>> runs(const Axes& axes, const Series& series,
                                           const std::vector<const std::vector<double>*>& values) {
    std::vector<std::vector<std::size_t>> result(1);
    for (std::size_t k = 0; k < series.x.size(); ++k) {
        bool drawn = can_be_drawn(series.x[k], axes.log_x);
        for (const std::vector<double>* one : values)
            drawn = drawn && can_be_drawn((*one)[k], axes.log_y);
        if (drawn)
            result.back().push_back(k);
        else if (!result.back().empty())
            result.emplace_back();
    }
    return result;
}

std::string draw_band(const Frame& frame, const Axes& axes, const Series& series,
                      std::size_t index) {
    if (series.low.empty())
        return {};
    std::string path;
    for (const auto& run : runs(axes, series, {&series.low, &series.high})) {
        if (run.empty())
            continue;
        std::string outline;
        for (const std::size_t k : run)
            outline += step(frame, k == run.front() ? 'M' : 'L', series.x[k], series.high[k]);
        for (auto k = run.rbegin(); k != run.rend(); ++k)
            outline += step(frame, 'L', series.x[*k], series.low[*k]);
        path += outline + "Z";
    }
    return fmt::format("<path d=\"{}\" fill=\"{}\" fill-opacity=\"0.2\"/>\n", path,
                       series_colour(index));
}

std::string draw_line(const Frame& frame, const Axes& axes, const Series& series,
                      std::size_t index) {
    std::string path;
    for (const auto& run : runs(axes, series, {&series.y}))
        for (const std::size_t k : run)
            path += step(frame, k == run.front() ? 'M' : 'L', series.x[k], series.y[k]);
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" "
                       "stroke-linejoin=\"round\"{}/>\n",
                       path, series_colour(index), dashes_of(index));
}

std::string mark(double x, double y, std::size_t index) {
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"{}\" "
                       "fill-opacity=\"0.75\"/>\n",
                       x, y, series_colour(index));
}

std::string draw_points(const Frame& frame, const Axes& axes, const Series& series,
                        std::size_t index) {
    std::string marks;
    for (const auto& run : runs(axes, series, {&series.y}))
        for (const std::size_t k : run)
            marks += mark(frame.x_of(series.x[k]), frame.y_of(series.y[k]), index);
    return marks;
}

constexpr double row_height = 19;    // of the legend
constexpr double below_frame = 52.0; // numbers and label of the x axis

/// A sample of the series and its label; `y` is the middle of the row.
std::string legend_entry(const Series& series, std::size_t look, double x, double y) {
    std::string entry;
    if (!series.low.empty())
        entry += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"24\" height=\"11\" "
                             "fill=\"{}\" fill-opacity=\"0.2\"/>\n",
                             x, y - 5.5, series_colour(look));
    entry += series.points ? mark(x + 12, y, look)
                           : fmt::format("<path d=\"M{:.1f} {:.1f}h24\" stroke=\"{}\" "
                                         "stroke-width=\"1.8\"{}/>\n",
                                         x, y, series_colour(look), dashes_of(look));
    return entry + text_at(x + 31, y + 4, "start", series.label);
}

std::string draw_legend(const Frame& frame, const std::vector<Series>& series) {
    double y = frame.top + 8;
    std::string legend;
    for (std::size_t k = 0; k < series.size(); ++k) {
        if (series[k].label.empty())
            continue;
        legend += legend_entry(series[k], look_of(series, k), frame.right() + 16, y);
        y += row_height;
    }
    return legend;
}

/// 7 pixels a character are generous.
double entry_width(const Series& series) {
    return 44.0 + 7.0 * static_cast<double>(series.label.size());
}

/// Entries in rows from the upper left on, as many in each as fit; `bottom` is where they end.
std::string draw_legend_above(const std::vector<Series>& series, double left, double right,
                              double& bottom) {
    std::string legend;
    double x = left;
    double y = 0.0;
    for (std::size_t k = 0; k < series.size(); ++k) {
        if (series[k].label.empty())
            continue;
        if (y == 0.0 || x + entry_width(series[k]) > right) {
            x = left;
            y += row_height;
        }
        legend += legend_entry(series[k], look_of(series, k), x, y - 0.5 * row_height);
        x += entry_width(series[k]);
    }
    bottom = y;
    return legend;
}

std::string draw_curves(const Frame& frame, const Axes& axes, const std::vector<Series>& series) {
    std::string curves;
    for (std::size_t k = 0; k < series.size(); ++k)
        curves += draw_band(frame, axes, series[k], look_of(series, k));
    for (std::size_t k = 0; k < series.size(); ++k)
        curves += series[k].points ? draw_points(frame, axes, series[k], look_of(series, k))
                                   : draw_line(frame, axes, series[k], look_of(series, k));
    return curves;
}

/// Room that the legend takes, from the length of its texts (7 pixels a character is generous).
double legend_width(const std::vector<Series>& series) {
    std::size_t longest = 0;
    for (const Series& one : series)
        longest = std::max(longest, one.label.size());
    return longest == 0 ? 24.0 : 60.0 + 7.0 * static_cast<double>(longest);
}

} // namespace

std::string line_plot(const Axes& axes, const std::vector<Series>& series) {
    for (const Series& one : series)
        check(one);
    Frame frame = frame_of(axes, series);
    frame.height = std::max(frame.height, row_height * static_cast<double>(series.size()));
    const std::string content = draw_frame(frame, axes.title, axes.x_label, axes.y_label, true) +
                                draw_curves(frame, axes, series) + draw_legend(frame, series);
    return document(frame.right() + legend_width(series), frame.bottom() + below_frame, content);
}

std::string line_plot_within(const Axes& axes, const std::vector<Series>& series, double width,
                             double height) {
    constexpr double right_margin = 16, smallest = 20;
    for (const Series& one : series)
        check(one);
    Frame frame = frame_of(axes, series);
    frame.width = std::max(smallest, width - frame.left - right_margin);
    double legend_bottom = 0.0;
    const std::string legend = draw_legend_above(series, frame.left, width, legend_bottom);
    frame.top = legend_bottom + (axes.title.empty() ? 8.0 : 32.0);
    frame.height = std::max(smallest, height - frame.top - below_frame);
    return draw_frame(frame, axes.title, axes.x_label, axes.y_label, true) +
           draw_curves(frame, axes, series) + legend;
}

} // namespace reradiant::svg
