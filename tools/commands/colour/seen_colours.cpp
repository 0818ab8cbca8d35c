#include "tools/commands/colour/seen_colours.h"

#include "host/spectral/evidence/scatter_warnings.h"
#include "reradiant/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace reradiant {

namespace {

/// Refuses polygons that no requested illuminant can test: their verdict would be missed.
std::vector<ColourPolygon> read_polygons(const ColourOptions& options) {
    if (options.polygons.empty())
        return {};
    std::vector<ColourPolygon> polygons = read_colour_polygons(options.polygons);
    const std::vector<Observer>& observers = options.observers;
    if (std::find(observers.begin(), observers.end(), Observer::Cie1931Deg2) == observers.end())
        throw_input_error({options.polygons.string()},
                          "polygons are regions of the diagram of the observer 1931-2",
                          "add 1931-2 to --observer");
    for (const ColourPolygon& polygon : polygons)
        if (std::none_of(options.lamps.begin(), options.lamps.end(),
                         [&](const Lamp& lamp) { return lamp.name == polygon.illuminant; }))
            throw_input_error(
                {options.polygons.string(), polygon.line, 1},
                fmt::format("'{}' is tested under {}", polygon.name, polygon.illuminant),
                fmt::format("add {} to --illuminant", polygon.illuminant));
    return polygons;
}

ColourReport report_of(const ColourSample& sample, ColourReporter& reporter,
                       const std::vector<std::string>& scatter) {
    try {
        return reporter.report_of(sample.matrix, scatter);
    } catch (const std::invalid_argument& error) {
        throw_input_error({sample.file.string()},
                          fmt::format("under {}, {}", reporter.lamp().name, error.what()),
                          "a colour needs emission bands in the visible, and light there");
    }
}

/// Reports of a sample by all reporters, in their order.
std::vector<ColourReport> reports_of(const ColourSample& sample,
                                     std::vector<ColourReporter>& reporters) {
    const std::vector<std::string> scatter = scatter_warnings(sample.matrix);
    std::vector<ColourReport> reports;
    for (ColourReporter& reporter : reporters)
        reports.push_back(report_of(sample, reporter, scatter));
    return reports;
}

/// All lamps for the first observer, then for the next.
std::vector<ColourReporter> reporters_of(const ColourOptions& options) {
    std::vector<ColourReporter> reporters;
    for (const Observer observer : options.observers)
        for (const Lamp& lamp : options.lamps)
            reporters.emplace_back(lamp, options.sum(), observer);
    return reporters;
}

/// From the first lamp of the same observer to this one.
void set_metamerism(SeenColour& test, const SeenColour& reference) {
    test.report.metamerism = metamerism_index(reference.against->colour, reference.report.colour,
                                              test.against->colour, test.report.colour);
}

std::vector<SeenColour> see_sample(const ColourSample& sample,
                                   std::vector<ColourReporter>& reporters,
                                   const std::vector<ColourReport>& references,
                                   const std::vector<ColourPolygon>& polygons,
                                   std::size_t lamp_count) {
    std::vector<SeenColour> seen;
    for (ColourReport& report : reports_of(sample, reporters)) {
        const std::size_t k = seen.size();
        test_polygons(report, polygons);
        if (references.empty()) {
            seen.push_back({std::move(report), {}});
            continue;
        }
        compare_with(report, references[k]);
        seen.push_back({std::move(report), references[k]});
        if (k % lamp_count > 0)
            set_metamerism(seen.back(), seen[k - k % lamp_count]);
    }
    return seen;
}

} // namespace

bool SeenSample::passes_a_polygon() const {
    for (const SeenColour& seen : colours)
        for (const PolygonVerdict& verdict : seen.report.polygons)
            if (verdict.result.passes())
                return true;
    return false;
}

std::vector<SeenSample> see_samples(const ColourOptions& options) {
    std::vector<ColourReporter> reporters = reporters_of(options);
    const std::vector<ColourPolygon> polygons = read_polygons(options);
    std::vector<ColourSample> samples = read_samples(options);
    std::vector<ColourReport> references;
    if (!options.against.empty())
        references = reports_of(read_reference(options), reporters);
    std::vector<SeenSample> seen;
    for (ColourSample& sample : samples) {
        std::vector<SeenColour> colours =
            see_sample(sample, reporters, references, polygons, options.lamps.size());
        seen.push_back({std::move(sample), std::move(colours)});
    }
    return seen;
}

std::vector<std::string> warnings_of(const SeenSample& sample) {
    std::vector<std::string> warnings;
    for (const SeenColour& seen : sample.colours)
        for (const std::string& warning : seen.report.warnings)
            if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
                warnings.push_back(warning);
    return warnings;
}

std::string key_of(const ColourReport& report, const ColourOptions& options) {
    return report_key(report, options.observers.size());
}

} // namespace reradiant
