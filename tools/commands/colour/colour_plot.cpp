#include "tools/commands/colour/colour_plot.h"

#include "host/report/svg.h"

namespace reradiant {

namespace {

/// `suffix` names the file where two are drawn.
void add_curves(std::vector<svg::Series>& series, const ColourReport& report, bool reflected,
                const std::string& suffix) {
    const MatrixColour& colour = report.colour;
    series.push_back({report.illuminant + " total" + suffix, colour.nm, colour.total});
    series.push_back({report.illuminant + " luminescent" + suffix, colour.nm, colour.luminescent});
    if (reflected) // drawn once: it is the same under every lamp
        series.push_back({"reflected" + suffix, colour.nm, colour.reflected});
}

std::string plot(const std::string& title, const std::vector<svg::Series>& series) {
    return svg::line_plot(
        {.title = title, .x_label = "wavelength / nm", .y_label = "radiance factor"}, series);
}

} // namespace

std::string factors_plot(const SeenSample& sample, const ColourOptions& options) {
    const std::string name = sample.sample.short_name;
    const std::string other = options.against.filename().string();
    const bool both = !other.empty();
    const std::size_t lamps = options.lamps.size();
    std::vector<svg::Series> series;
    for (std::size_t k = 0; k < lamps; ++k)
        add_curves(series, sample.colours[k].report, k + 1 == lamps, both ? ", " + name : "");
    for (std::size_t k = 0; both && k < lamps; ++k)
        add_curves(series, *sample.colours[k].against, k + 1 == lamps, ", " + other);
    return plot(both ? name + " and " + other : name, series);
}

std::string totals_plot(const std::vector<SeenSample>& samples, const ColourOptions& options) {
    std::vector<svg::Series> series;
    const auto add = [&](const ColourReport& report, const std::string& name) {
        const std::string lamp = options.lamps.size() > 1 ? report.illuminant + ", " : "";
        series.push_back({lamp + name, report.colour.nm, report.colour.total});
    };
    for (const SeenSample& sample : samples)
        for (std::size_t k = 0; k < options.lamps.size(); ++k)
            add(sample.colours[k].report, sample.sample.short_name);
    if (!options.against.empty())
        for (std::size_t k = 0; k < options.lamps.size(); ++k)
            add(*samples.front().colours[k].against, options.against.filename().string());
    const std::string lamp = options.lamps.size() == 1 ? " under " + options.lamps[0].name : "";
    return plot("total radiance factor" + lamp, series);
}

} // namespace reradiant
