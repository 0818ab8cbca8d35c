#include "host/report/plot_frame.h"

#include "host/report/html.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace reradiant::svg {

namespace {

constexpr int wanted_intervals = 6;

std::string superscript(int exponent) {
    static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = exponent < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(exponent)))
        text += digits[digit - '0'];
    return text;
}

/// 1, 2 or 5 times a power of ten, such that the range has about `wanted_intervals` of them.
double round_step(double range) {
    const double raw = range / wanted_intervals;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    const double mantissa = raw / power;
    return power * (mantissa <= 1.0 ? 1.0 : mantissa <= 2.0 ? 2.0 : mantissa <= 5.0 ? 5.0 : 10.0);
}

void add_tick(Axis& axis, double value) {
    const double slack = 1e-9 * (axis.is_log ? value : axis.high - axis.low);
    if (value < axis.low - slack || value > axis.high + slack)
        return;
    axis.ticks.push_back(value);
    axis.labels.push_back(number_label(value));
}

void make_linear(Axis& axis, bool exact) {
    if (!(axis.high > axis.low)) {
        const double margin = axis.low == 0.0 ? 1.0 : 0.1 * std::abs(axis.low);
        axis.low -= margin;
        axis.high += margin;
    }
    const double step = round_step(axis.high - axis.low);
    // A thousandth of a step, so that rounding does not add an empty interval.
    const double first = std::floor(axis.low / step + 1e-3),
                 last = std::ceil(axis.high / step - 1e-3);
    if (!exact) {
        axis.low = first * step;
        axis.high = last * step;
    }
    // A large number with a tiny range may have no more than rounding left between its ends.
    for (double k = first; k <= last && axis.ticks.size() < 20; k += 1.0)
        add_tick(axis, k * step);
}

void make_logarithmic(Axis& axis, bool exact) {
    if (!(axis.high > axis.low)) {
        axis.low /= 2.0;
        axis.high *= 2.0;
    }
    const int first = static_cast<int>(std::floor(std::log10(axis.low) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(axis.high) - 1e-9));
    // Two decades or less have too few powers of ten to read values off.
    const bool few = last - first <= 2;
    const int stride = std::max(1, (last - first + 7) / 8);
    std::vector<double> ticks;
    for (int decade = first; decade <= last; decade += stride)
        for (const double factor : few ? std::vector<double>{1, 2, 5} : std::vector<double>{1})
            ticks.push_back(factor * std::pow(10.0, decade));
    if (!exact) {
        const double low = axis.low * (1 + 1e-9), high = axis.high * (1 - 1e-9);
        axis.low = *(std::upper_bound(ticks.begin(), ticks.end(), low) - 1);
        const auto end = std::lower_bound(ticks.begin(), ticks.end(), high);
        axis.high = end == ticks.end() ? axis.high : *end;
    }
    for (const double tick : ticks)
        add_tick(axis, tick);
}

std::string line(double x1, double y1, double x2, double y2, const char* colour) {
    return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2, y2,
                       colour);
}

constexpr const char* grid_colour = "#e4e4e4";
constexpr const char* frame_colour = "#444";
constexpr double tick_length = 5;

} // namespace

double Axis::share(double value) const {
    return is_log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

Axis make_axis(double low, double high, bool is_log, bool exact) {
    Axis axis{.low = low, .high = high, .is_log = is_log, .ticks = {}, .labels = {}};
    if (is_log)
        make_logarithmic(axis, exact);
    else
        make_linear(axis, exact);
    return axis;
}

const char* series_colour(std::size_t index) {
    // Okabe and Ito 2008; black comes last.
    constexpr std::array<const char*, series_colours> colours = {
        "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
    return colours[index % colours.size()];
}

std::string number_label(double value) {
    if (value == 0.0 || (std::abs(value) >= 0.999e-3 && std::abs(value) < 0.99999e5))
        return fmt::format("{:.6g}", value);
    int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
    double mantissa = value / std::pow(10.0, exponent);
    if (std::abs(mantissa) > 9.99999) {
        mantissa /= 10.0;
        ++exponent;
    }
    const std::string factor = fmt::format("{:.4g}", mantissa);
    const std::string power = "10" + superscript(exponent);
    return factor == "1" ? power : factor == "-1" ? "-" + power : factor + "·" + power;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text,
                    int size) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}"
                       "</text>\n",
                       x, y, anchor, size, markup_escaped(text));
}

std::string draw_frame(const Frame& frame, const std::string& title, const std::string& x_label,
                       const std::string& y_label, bool grid) {
    std::string lines, texts;
    for (std::size_t k = 0; k < frame.x.ticks.size(); ++k) {
        const double x = frame.x_of(frame.x.ticks[k]);
        if (grid)
            lines += line(x, frame.top, x, frame.bottom(), grid_colour);
        lines += line(x, frame.bottom(), x, frame.bottom() + tick_length, frame_colour);
        texts += text_at(x, frame.bottom() + 18, "middle", frame.x.labels[k]);
    }
    for (std::size_t k = 0; k < frame.y.ticks.size(); ++k) {
        const double y = frame.y_of(frame.y.ticks[k]);
        if (grid)
            lines += line(frame.left, y, frame.right(), y, grid_colour);
        lines += line(frame.left - tick_length, y, frame.left, y, frame_colour);
        texts += text_at(frame.left - 8, y + 4, "end", frame.y.labels[k]);
    }
    const double middle_x = frame.left + 0.5 * frame.width;
    const double middle_y = frame.top + 0.5 * frame.height;
    texts += text_at(middle_x, frame.bottom() + 38, "middle", x_label, 13);
    texts += text_at(middle_x, frame.top - 14, "middle", title, 15);
    texts += fmt::format("<g transform=\"translate(18 {:.1f}) rotate(-90)\">{}</g>\n", middle_y,
                         text_at(0, 0, "middle", y_label, 13));
    const std::string border =
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                    "stroke=\"{}\"/>\n",
                    frame.left, frame.top, frame.width, frame.height, frame_colour);
    return "<g fill=\"none\">\n" + lines + border + "</g>\n" + texts;
}

std::string document(double width, double height, const std::string& content) {
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" "
                       "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
                       "font-family=\"Helvetica, Arial, sans-serif\" fill=\"#222\">\n"
                       "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#fff\"/>\n{2}</svg>\n",
                       width, height, content);
}

} // namespace reradiant::svg
