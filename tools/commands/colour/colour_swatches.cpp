#include "tools/commands/colour/colour_swatches.h"

#include "host/report/html.h"
#include "host/report/plot_frame.h"
#include "host/spectral/colour/screen_colour.h"

#include <fmt/format.h>

#include <algorithm>

namespace reradiant {

namespace {

constexpr double field_width = 96, gap = 6, head = 30;
constexpr double letter = 7; // generous, at 12 pixels
constexpr std::size_t most_letters = 48;
/// Lower fields where there are many.
double field_height(std::size_t samples) {
    return samples > 12 ? 28 : 56;
}

/// A text that is not longer than its place: the end of a path says most.
std::string shortened(const std::string& text) {
    return text.size() <= most_letters ? text : "…" + text.substr(text.size() - (most_letters - 1));
}

/// A rectangle of the page.
struct Box {
    double x, y, width, height;
};

std::string half(const Box& box, const MatrixColour& colour, const std::string& title) {
    const ScreenColour shown = screen_colour(colour);
    std::string svg =
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                    "height=\"{:.1f}\" fill=\"{}\"><title>{}</title></rect>\n",
                    box.x, box.y, box.width, box.height, shown.hex, markup_escaped(title));
    if (shown.is_clipped)
        svg += fmt::format("<path d=\"M{:.1f} {:.1f}h-11l11 11z\" fill=\"#fff\"/>\n",
                           box.x + box.width, box.y);
    return svg;
}

std::string title_of(const std::string& name, const ColourReport& report) {
    const auto& lab = report.colour.lab;
    return fmt::format("{}, {}, {}: Lab {:.2f} {:.2f} {:.2f}", name, report.illuminant,
                       observer_name(report.observer), lab[0], lab[1], lab[2]);
}

std::string field(const Box& box, const SeenSample& sample, const SeenColour& seen,
                  const std::string& reference) {
    const std::string title = title_of(sample.sample.short_name, seen.report);
    if (!seen.against)
        return half(box, seen.report.colour, title);
    Box left = box, right = box;
    left.width = right.width = 0.5 * box.width;
    right.x += right.width;
    return half(left, seen.report.colour, title) +
           half(right, seen.against->colour, title_of(reference, *seen.against));
}

} // namespace

std::string swatches(const std::vector<SeenSample>& samples, Observer observer,
                     const ColourOptions& options) {
    std::size_t longest = 0;
    for (const SeenSample& sample : samples)
        longest = std::max(longest, shortened(sample.sample.short_name).size());
    const double left = letter * static_cast<double>(longest) + 16;
    std::string content;
    for (std::size_t k = 0; k < options.lamps.size(); ++k)
        content +=
            svg::text_at(left + (static_cast<double>(k) + 0.5) * (field_width + gap) - 0.5 * gap,
                         head - 10, "middle", shortened(options.lamps[k].name));
    const double height = field_height(samples.size());
    double y = head;
    for (const SeenSample& sample : samples) {
        content += svg::text_at(left - 10, y + 0.5 * height + 4, "end",
                                shortened(sample.sample.short_name));
        double x = left;
        for (const SeenColour& seen : sample.colours)
            if (seen.report.observer == observer) {
                content += field({x, y, field_width, height}, sample, seen,
                                 options.against.filename().string());
                x += field_width + gap;
            }
        y += height + gap;
    }
    const double width = left + static_cast<double>(options.lamps.size()) * (field_width + gap);
    return svg::document(width, y, content);
}

} // namespace reradiant
