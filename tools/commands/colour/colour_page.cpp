#include "tools/commands/colour/colour_page.h"

#include "host/report/chromaticity_diagram.h"
#include "host/report/html.h"
#include "host/spectral/colour/colour_report.h"
#include "tools/commands/colour/colour_plot.h"
#include "tools/commands/colour/colour_swatches.h"
#include "tools/commands/colour/colour_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace reradiant {

namespace {

using svg::Chromaticity;

/// More numbers would hide the dots.
constexpr std::size_t most_numbered = 30;

std::string title_of(const std::vector<SeenSample>& samples) {
    if (samples.size() == 1)
        return "Colour of " + samples.front().sample.short_name;
    return fmt::format("Colours of {} samples", samples.size());
}

std::string observer_title(Observer observer) {
    return "observer " + observer_name(observer);
}

Chromaticity chromaticity(const Xyz& xyz) {
    const double sum = xyz[0] + xyz[1] + xyz[2];
    return {xyz[0] / sum, xyz[1] / sum};
}

std::string without_ultraviolet() {
    return fmt::format("Without what light below {:g} nm excites:", uv_excluded_from_nm);
}

void add_swatches(HtmlPage& page, const std::vector<SeenSample>& samples,
                  const ColourOptions& options) {
    page.heading("Swatches");
    for (const Observer observer : options.observers)
        page.figure(swatches(samples, observer, options),
                    fmt::format("As {} sees them beside a white of the same lamp, adapted to the "
                                "screen's white.{} A white corner marks a colour that is brighter "
                                "or more saturated than a screen shows.",
                                observer_title(observer),
                                options.against.empty()
                                    ? std::string()
                                    : fmt::format(" The right half is {}.",
                                                  options.against.filename().string())));
}

void add_table(HtmlPage& page, const ColourTable& table) {
    page.table(table.header, table.rows);
}

void add_colours(HtmlPage& page, const std::vector<SeenSample>& samples,
                 const ColourOptions& options) {
    page.heading("Colours");
    add_table(page, colour_table(samples, options, false));
    page.paragraph("The perfect diffuser has Y = 100; Lab is that of CIE 1976 relative to the "
                   "lamp's own white. A matrix without a geometry is as its instrument measured "
                   "it.");
    page.paragraph(without_ultraviolet());
    add_table(page, colour_table(samples, options, true));
}

void add_indices(HtmlPage& page, const std::vector<SeenSample>& samples,
                 const ColourOptions& options) {
    page.heading("Indices of white and yellow");
    const ColourTable indices = index_table(samples, options, false);
    if (!indices.rows.empty()) {
        add_table(page, indices);
        page.paragraph(without_ultraviolet());
        add_table(page, index_table(samples, options, true));
    }
    page.paragraph("They are defined for D65 and C; whiteness and E313 for the observers 1931-2 "
                   "and 1964-10.");
}

void add_differences(HtmlPage& page, const std::vector<SeenSample>& samples,
                     const ColourOptions& options) {
    if (options.against.empty())
        return;
    page.heading("Differences from " + options.against.filename().string());
    add_table(page, difference_table(samples, options));
}

/// Polygons are drawn where they are tested, once each.
std::vector<svg::ChromaticityRegion> regions_of(const std::vector<SeenSample>& samples) {
    std::vector<svg::ChromaticityRegion> regions;
    for (const SeenColour& seen : samples.front().colours)
        for (const PolygonVerdict& verdict : seen.report.polygons)
            regions.push_back({verdict.polygon.name, verdict.polygon.corners});
    return regions;
}

svg::ChromaticityDiagram empty_diagram(Observer observer, const ColourOptions& options) {
    svg::ChromaticityDiagram diagram;
    diagram.title = observer_title(observer);
    const std::string index = observer == Observer::Cie1931Deg2    ? ""
                              : observer == Observer::Cie1964Deg10 ? "10"
                              : observer == Observer::Cie2015Deg2  ? "F"
                                                                   : "F,10";
    diagram.x_label = "x" + index;
    diagram.y_label = "y" + index;
    const ColourMatching& eye = colour_matching(observer);
    for (std::size_t k = 0; k < eye.wavelengths_nm.size(); ++k)
        if (eye.wavelengths_nm[k] <= 700.0) { // beyond, the locus turns back by rounding
            diagram.nm.push_back(eye.wavelengths_nm[k]);
            diagram.locus.push_back(chromaticity({eye.x[k], eye.y[k], eye.z[k]}));
        }
    for (const Lamp& lamp : options.lamps)
        diagram.series.push_back(lamp.name);
    return diagram;
}

std::string diagram_of(const std::vector<SeenSample>& samples, Observer observer,
                       const ColourOptions& options) {
    svg::ChromaticityDiagram diagram = empty_diagram(observer, options);
    if (observer == Observer::Cie1931Deg2)
        diagram.regions = regions_of(samples);
    const bool is_numbered = samples.size() > 1 && samples.size() <= most_numbered;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        std::size_t lamp = 0;
        for (const SeenColour& seen : samples[k].colours) {
            if (seen.report.observer != observer)
                continue;
            if (k == 0)
                diagram.whites.push_back(chromaticity(seen.report.colour.white));
            const Chromaticity xy = seen.report.colour.xy;
            diagram.points.push_back(
                {fmt::format("{}, {}: {:.4f}, {:.4f}", samples[k].sample.short_name,
                             seen.report.illuminant, xy[0], xy[1]),
                 is_numbered && lamp == 0 ? std::to_string(k + 1) : "", lamp++, xy,
                 seen.report.uv_excluded.colour.xy});
        }
    }
    return svg::chromaticity_diagram(diagram);
}

void add_diagrams(HtmlPage& page, const std::vector<SeenSample>& samples,
                  const ColourOptions& options) {
    page.heading("Chromaticity");
    for (const Observer observer : options.observers)
        page.figure(diagram_of(samples, observer, options),
                    fmt::format("A dot is a sample under a lamp, the ring at its other end the "
                                "same without what light below {:g} nm excites.{}",
                                uv_excluded_from_nm,
                                samples.size() > 1
                                    ? " Numbers count the samples in the order of the tables, at "
                                      "their dots under the first lamp."
                                    : ""));
    if (options.polygons.empty())
        return;
    std::vector<std::vector<std::string>> rows;
    for (const SeenSample& sample : samples)
        for (const SeenColour& seen : sample.colours)
            for (const PolygonVerdict& verdict : seen.report.polygons)
                rows.push_back({sample.sample.short_name, seen.report.illuminant,
                                verdict.polygon.name,
                                verdict.result.chromaticity ? "inside" : "outside",
                                fmt::format("{:.4f}", seen.report.colour.xyz[1] / 100.0),
                                fmt::format("{:.4g}", verdict.polygon.minimum_luminance_factor),
                                verdict.result.passes() ? "passes" : "fails"});
    page.table({"sample", "lamp", "polygon", "chromaticity", "luminance factor", "at least", ""},
               rows);
}

void add_factors(HtmlPage& page, const std::vector<SeenSample>& samples,
                 const ColourOptions& options) {
    page.heading("Radiance factors");
    for (const SeenSample& sample : samples)
        page.figure(factors_plot(sample, options), "");
    page.paragraph("Total = reflected + luminescent. The luminescent part is relative to the light "
                   "that the lamp has at the same wavelength, and a gap where it has none.");
}

void add_lamps(HtmlPage& page, const std::vector<SeenSample>& samples) {
    page.heading("Lamps");
    std::vector<std::vector<std::string>> rows;
    std::set<std::string> known;
    for (const SeenColour& seen : samples.front().colours) {
        const ColourReport& report = seen.report;
        if (known.insert(report.illuminant).second)
            rows.push_back(
                {report.illuminant, fmt::format("{:.2f} %", 100.0 * report.ultraviolet_share),
                 report.colour.reason.empty()
                     ? (report.colour.at_nanometres ? "summed over 1 nm" : "summed at the bands")
                     : report.colour.reason});
    }
    page.table({"lamp", "of its irradiance below 400 nm", "sums"}, rows);
}

void add_warnings(HtmlPage& page, const std::vector<SeenSample>& samples) {
    std::vector<std::vector<std::string>> rows;
    for (const SeenSample& sample : samples)
        for (const std::string& warning : warnings_of(sample))
            rows.push_back({sample.sample.short_name, warning});
    if (rows.empty())
        return;
    page.heading("Warnings");
    page.table({"sample", "warning"}, rows);
}

} // namespace

std::string colour_page(const std::vector<SeenSample>& samples, const ColourOptions& options) {
    HtmlPage page(title_of(samples));
    add_swatches(page, samples, options);
    add_colours(page, samples, options);
    add_indices(page, samples, options);
    add_differences(page, samples, options);
    add_diagrams(page, samples, options);
    add_lamps(page, samples);
    add_warnings(page, samples);
    add_factors(page, samples, options);
    return page.text();
}

} // namespace reradiant
