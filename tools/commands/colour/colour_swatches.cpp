#include "tools/commands/colour/colour_swatches.h"

#include "host/report/html.h"
#include "host/report/plot_frame.h"
#include "host/spectral/colour/screen_colour.h"

#include <fmt/format.h>

#include <algorithm>

namespace reradiant {

namespace {

constexpr double field_width = 96, field_height = 56, gap = 6, head = 30;
constexpr double letter = 7; // generous, at 12 pixels
constexpr std::size_t most_letters = 48;
/// A text that is not longer than its place: the end of a path says most.
std::string shortened(const std::string& text) {
    return text.size() <= most_letters ? text : "…" + text.substr(text.size() - (most_letters - 1));
}

std::string half(double x, double y, double width, const MatrixColour& colour,
                 const std::string& title) {
    const ScreenColour shown = screen_colour(colour);
    std::string svg = fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                                  "height=\"{:.1f}\" fill=\"{}\"><title>{}</title></rect>\n",
                                  x, y, width, field_height, shown.hex, markup_escaped(title));
    if (shown.is_clipped)
        svg += fmt::format("<path d=\"M{:.1f} {:.1f}h-11l11 11z\" fill=\"#fff\"/>\n", x + width, y);
    return svg;
}

std::string title_of(const std::string& name, const ColourReport& report) {
    const auto& lab = report.colour.lab;
    return fmt::format("{}, {}, {}: Lab {:.2f} {:.2f} {:.2f}", name, report.illuminant,
                       observer_name(report.observer), lab[0], lab[1], lab[2]);
}

std::string field(double x, double y, const SeenSample& sample, const SeenColour& seen,
                  const std::string& reference) {
    const std::string title = title_of(sample.sample.short_name, seen.report);
    if (!seen.against)
        return half(x, y, field_width, seen.report.colour, title);
    return half(x, y, 0.5 * field_width, seen.report.colour, title) +
           half(x + 0.5 * field_width, y, 0.5 * field_width, seen.against->colour,
                title_of(reference, *seen.against));
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
    double y = head;
    for (const SeenSample& sample : samples) {
        content += svg::text_at(left - 10, y + 0.5 * field_height + 4, "end",
                                shortened(sample.sample.short_name));
        double x = left;
        for (const SeenColour& seen : sample.colours)
            if (seen.report.observer == observer) {
                content += field(x, y, sample, seen, options.against.filename().string());
                x += field_width + gap;
            }
        y += field_height + gap;
    }
    const double width = left + static_cast<double>(options.lamps.size()) * (field_width + gap);
    return svg::document(width, y, content);
}

} // namespace reradiant
