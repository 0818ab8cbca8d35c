#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace reradiant::svg {

/// An axis of a plot: its range and where it is labelled.
struct Axis {
    double low = 0.0, high = 1.0;
    bool is_log = false;
    std::vector<double> ticks; ///< ascending, within [low, high]; 1, 2 or 5 times a power of ten
    std::vector<std::string> labels;

    /// Share of the axis' length, 0 at `low`, 1 at `high`.
    double share(double value) const;
};

/// An axis that holds [low, high] (both > 0 when logarithmic). A range without extent is widened.
/// With `exact` the ends stay where they are, otherwise they move out to a tick.
Axis make_axis(double low, double high, bool is_log, bool exact);

/// The colour of a plot's series: told apart by readers with any colour vision, they return after
/// `series_colours`.
const char* series_colour(std::size_t index);
inline constexpr std::size_t series_colours = 7;

/// A number as plots print it: few digits, powers of ten as such.
std::string number_label(double value);

/// A `Frame` says where on the page a plot's data lie, in pixels; y grows downwards.
struct Frame {
    double left = 78, top = 40, width = 480, height = 320;
    Axis x, y;

    double right() const { return left + width; }
    double bottom() const { return top + height; }
    double x_of(double value) const { return left + width * x.share(value); }
    double y_of(double value) const { return bottom() - height * y.share(value); }
};

/// Text at a place; anchor is start, middle or end.
std::string text_at(double x, double y, const std::string& anchor, const std::string& text,
                    int size = 12);
/// The frame's border, ticks, labels and title; with `grid` thin lines across.
std::string draw_frame(const Frame& frame, const std::string& title, const std::string& x_label,
                       const std::string& y_label, bool grid);
/// The <svg> element of a size around its content.
std::string document(double width, double height, const std::string& content);

} // namespace reradiant::svg
