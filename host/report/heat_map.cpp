#include "host/report/colour_map.h"
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

constexpr std::size_t colour_count = std::tuple_size_v<ColourTable>;

/// Step of centres; a single cell is 1 wide.
double step_of(const std::vector<double>& centres, const char* name) {
    if (centres.empty())
        throw std::invalid_argument(fmt::format("a heat map has no {} centres", name));
    if (centres.size() == 1)
        return 1.0;
    const double step =
        (centres.back() - centres.front()) / static_cast<double>(centres.size() - 1);
    for (std::size_t k = 0; k < centres.size(); ++k) {
        const double expected = centres.front() + static_cast<double>(k) * step;
        if (!(step > 0.0) || !(std::abs(centres[k] - expected) <= 1e-6 * step))
            throw std::invalid_argument(
                fmt::format("{} centre {} of a heat map is not in equal ascending steps", name, k));
    }
    return step;
}

Axis cell_axis(const std::vector<double>& centres, const char* name) {
    const double half = 0.5 * step_of(centres, name);
    return make_axis(centres.front() - half, centres.back() + half, false, true);
}

/// A `ColourScale` holds the values at the two ends of the colour bar.
struct ColourScale {
    double low = 0.0, high = 1.0;

    std::size_t index(double value) const {
        const double share = (value - low) / (high - low);
        return static_cast<std::size_t>(
            std::clamp(share * colour_count, 0.0, static_cast<double>(colour_count - 1)));
    }
};

ColourScale scale_of(const HeatMap& map) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (Eigen::Index k = 0; k < map.value.size(); ++k)
        if (const double value = map.value.data()[k]; std::isfinite(value)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    if (!(low <= high))
        return {};
    if (map.diverging) {
        const double size = std::max({std::abs(low), std::abs(high)});
        return size > 0.0 ? ColourScale{-size, size} : ColourScale{-1.0, 1.0};
    }
    low = std::min(low, 0.0);
    return high > low ? ColourScale{low, high} : ColourScale{low, low + 1.0};
}

/// Cells in units of cells, row 0 at the bottom, merged along rows: one path a colour keeps a
/// matrix of 97 x 81 entries near 100 kB.
std::string draw_cells(const HeatMap& map, const ColourScale& scale, const Frame& frame) {
    std::array<std::string, colour_count + 1> paths; // the last one: not measured
    const auto paint = [&](Eigen::Index row, Eigen::Index column) {
        const double value = map.value(row, column);
        return std::isfinite(value) ? scale.index(value) : colour_count;
    };
    for (Eigen::Index row = 0; row < map.value.rows(); ++row)
        for (Eigen::Index begin = 0, end = 0; begin < map.value.cols(); begin = end) {
            const std::size_t colour = paint(row, begin);
            for (end = begin + 1; end < map.value.cols() && paint(row, end) == colour;)
                ++end;
            paths[colour] += fmt::format("M{} {}h{}v1h-{}z", begin, row, end - begin, end - begin);
        }
    const ColourTable& colours = map.diverging ? diverging_colours() : sequential_colours();
    std::string cells =
        fmt::format("<g shape-rendering=\"crispEdges\" transform=\"translate({:.1f} {:.1f}) "
                    "scale({:.6f} {:.6f})\">\n",
                    frame.left, frame.bottom(), frame.width / static_cast<double>(map.value.cols()),
                    -frame.height / static_cast<double>(map.value.rows()));
    for (std::size_t k = 0; k <= colour_count; ++k)
        if (!paths[k].empty())
            cells += fmt::format("<path fill=\"{}\" d=\"{}\"/>\n",
                                 k < colour_count ? hex_colour(colours[k]) : "#bbb", paths[k]);
    return cells + "</g>\n";
}

/// A stroke across each cell that holds no number.
std::string draw_hatching(const HeatMap& map, const Frame& frame) {
    const double width = frame.width / static_cast<double>(map.value.cols());
    const double height = frame.height / static_cast<double>(map.value.rows());
    std::string path;
    for (Eigen::Index row = 0; row < map.value.rows(); ++row)
        for (Eigen::Index column = 0; column < map.value.cols(); ++column)
            if (!std::isfinite(map.value(row, column)))
                path +=
                    fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}",
                                frame.left + static_cast<double>(column) * width,
                                frame.bottom() - static_cast<double>(row) * height, width, -height);
    return path.empty() ? path : fmt::format("<path d=\"{}\" stroke=\"#777\"/>\n", path);
}

/// An outline around each marked cell, within it, so that those of neighbours are told apart.
std::string draw_marks(const HeatMap& map, const Frame& frame) {
    const double width = frame.width / static_cast<double>(map.value.cols());
    const double height = frame.height / static_cast<double>(map.value.rows());
    constexpr double inset = 0.5;
    std::string path;
    for (Eigen::Index row = 0; row < map.marked.rows(); ++row)
        for (Eigen::Index column = 0; column < map.marked.cols(); ++column)
            if (map.marked(row, column) > 0.0)
                path += fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}z",
                                    frame.left + static_cast<double>(column) * width + inset,
                                    frame.bottom() - static_cast<double>(row) * height - inset,
                                    width - 2.0 * inset, 2.0 * inset - height, 2.0 * inset - width);
    return path.empty() ? path
                        : fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#e3211c\"/>\n", path);
}

std::string draw_colour_bar(const HeatMap& map, const ColourScale& scale, const Frame& frame) {
    constexpr double bar_width = 18;
    const double left = frame.right() + 20;
    const ColourTable& colours = map.diverging ? diverging_colours() : sequential_colours();
    std::string bar = "<g shape-rendering=\"crispEdges\">\n";
    const double step = frame.height / colour_count;
    for (std::size_t k = 0; k < colour_count; ++k)
        bar += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"{}\" height=\"{:.2f}\" "
                           "fill=\"{}\"/>\n",
                           left, frame.bottom() - static_cast<double>(k + 1) * step, bar_width,
                           step + 0.5, hex_colour(colours[k]));
    bar += "</g>\n";
    const Axis axis = make_axis(scale.low, scale.high, false, true);
    for (std::size_t k = 0; k < axis.ticks.size(); ++k) {
        const double y = frame.bottom() - frame.height * axis.share(axis.ticks[k]);
        bar += fmt::format("<path d=\"M{:.1f} {:.1f}h4\" stroke=\"#444\"/>\n", left + bar_width, y);
        bar += text_at(left + bar_width + 7, y + 4, "start", axis.labels[k]);
    }
    return bar;
}

} // namespace

std::string heat_map(const HeatMap& map) {
    Frame frame;
    frame.x = cell_axis(map.x, "x");
    frame.y = cell_axis(map.y, "y");
    if (map.value.rows() != static_cast<Eigen::Index>(map.y.size()) ||
        map.value.cols() != static_cast<Eigen::Index>(map.x.size()))
        throw std::invalid_argument(fmt::format("a heat map of {} x {} values has {} y and {} x",
                                                map.value.rows(), map.value.cols(), map.y.size(),
                                                map.x.size()));
    if (map.marked.size() > 0 &&
        (map.marked.rows() != map.value.rows() || map.marked.cols() != map.value.cols()))
        throw std::invalid_argument(fmt::format("a heat map of {} x {} values has {} x {} marks",
                                                map.value.rows(), map.value.cols(),
                                                map.marked.rows(), map.marked.cols()));
    frame.width = 400;
    frame.height = 360;
    const ColourScale scale = scale_of(map);
    const std::string content = draw_cells(map, scale, frame) + draw_hatching(map, frame) +
                                draw_marks(map, frame) +
                                draw_frame(frame, map.title, map.x_label, map.y_label, false) +
                                draw_colour_bar(map, scale, frame);
    return document(frame.right() + 120, frame.bottom() + 52, content);
}

} // namespace reradiant::svg
