#include "host/spectral/colour/colour_report.h"

#include "host/spectral/covariance/colour_intervals.h"
#include "host/spectral/evidence/scatter_warnings.h"

#include <cmath>
#include <utility>

namespace reradiant {

namespace {

using Json = nlohmann::ordered_json;

IndexedColour indexed(MatrixColour colour, const std::string& lamp, Observer observer) {
    IndexedColour result;
    const bool has_whiteness = lamp == "D65" || lamp == "C";
    const bool is_classic = observer == Observer::Cie1931Deg2 || observer == Observer::Cie1964Deg10;
    if (has_whiteness && is_classic)
        result.whiteness = cie_whiteness(colour.xyz, colour.white, observer);
    result.e313 = astm_e313(colour.xyz, lamp, observer);
    if (has_whiteness)
        result.r457 = r457(colour);
    result.lch = lab_to_lch(colour.lab);
    result.colour = std::move(colour);
    return result;
}

Json indices_json(const IndexedColour& of) {
    Json json = {
        {"XYZ", of.colour.xyz}, {"xy", of.colour.xy}, {"Lab", of.colour.lab}, {"LCh", of.lch}};
    if (of.whiteness)
        json.update({{"whiteness_cie", of.whiteness->whiteness}, {"tint_cie", of.whiteness->tint}});
    if (of.r457)
        json["r457"] = *of.r457;
    if (of.e313)
        json.update(
            {{"whiteness_e313", of.e313->whiteness}, {"yellowness_e313", of.e313->yellowness}});
    return json;
}

Json polygons_json(const std::vector<PolygonVerdict>& polygons) {
    Json json;
    for (const PolygonVerdict& verdict : polygons)
        json.push_back({{"name", verdict.polygon.name},
                        {"passes", verdict.result.passes()},
                        {"chromaticity", verdict.result.chromaticity},
                        {"luminance_factor", verdict.result.luminance_factor}});
    return json;
}

Json differences_json(const ColourDifferences& differences) {
    return {{"cie1976", differences.cie1976},
            {"cie1994", differences.cie1994},
            {"ciede2000", differences.ciede2000},
            {"cmc21", differences.cmc21}};
}

} // namespace

std::size_t ColourReport::brightest_band() const {
    std::size_t best = 0;
    for (std::size_t o = 0; o < colour.total.size(); ++o)
        if (!(colour.total[o] <= colour.total[best]) && !std::isnan(colour.total[o]))
            best = o;
    return best;
}

ColourReporter::ColourReporter(Lamp lamp, ColourSum sum, Observer observer)
    : lamp_(std::move(lamp)), observer_(observer),
      whole_(lamp_.light, sum, {.observer = observer, .weighted_by = lamp_.weighted_by}),
      uv_excluded_(lamp_.light, sum,
                   {.observer = observer,
                    .weighted_by = lamp_.weighted_by,
                    .excites_from_nm = uv_excluded_from_nm}),
      ultraviolet_share_(ultraviolet_share(lamp_.light)),
      faint_white_(faint_white_warning(lamp_, observer)) {}

ColourReport ColourReporter::report_of(const ReradiationMatrix& matrix,
                                       std::vector<std::string> scatter) {
    ColourReport report;
    static_cast<IndexedColour&>(report) = indexed(whole_.colour_of(matrix), lamp_.name, observer_);
    // Summed as the whole is, so that the difference is the fluorescence alone.
    report.uv_excluded =
        indexed(uv_excluded_.colour_of(matrix, report.colour.at_nanometres), lamp_.name, observer_);
    report.illuminant = lamp_.name;
    report.observer = observer_;
    report.ultraviolet_share = ultraviolet_share_;
    report.warnings = std::move(scatter);
    for (std::string& warning : lamp_warnings(matrix, lamp_, observer_))
        report.warnings.push_back(std::move(warning));
    if (!faint_white_.empty())
        report.warnings.push_back(faint_white_);
    return report;
}

ColourReport colour_report(const ReradiationMatrix& matrix, const Lamp& lamp, ColourSum sum,
                           Observer observer) {
    return ColourReporter(lamp, sum, observer).report_of(matrix, scatter_warnings(matrix));
}

void compare_with(ColourReport& report, const ColourReport& reference) {
    report.differences = colour_differences(reference.colour.lab, report.colour.lab);
}

nlohmann::ordered_json colour_report_json(const ColourReport& report) {
    const MatrixColour& colour = report.colour;
    const std::size_t brightest = report.brightest_band();
    Json json = indices_json(report);
    json.update(
        {{"white_XYZ", colour.white},
         {"sums", colour.at_nanometres ? "1 nm" : "bands"},
         {"luminance_factor",
          {{"total", colour.xyz[1] / 100.0},
           {"reflected", colour.luminance_reflected / 100.0},
           {"luminescent", (colour.xyz[1] - colour.luminance_reflected) / 100.0}}},
         {"largest_beta_T", {{"value", colour.total[brightest]}, {"nm", colour.nm[brightest]}}},
         {"observer", observer_name(report.observer)},
         {"uv_share", report.ultraviolet_share},
         {"uv_excluded", indices_json(report.uv_excluded)}});
    if (report.whiteness)
        json.update({{"whiteness", report.whiteness->whiteness},
                     {"tint", report.whiteness->tint},
                     {"whiteness_within_limits", report.whiteness->within_limits}});
    if (report.differences)
        json.update({{"delta_e", differences_json(*report.differences)},
                     {"ciede2000", report.differences->ciede2000}});
    if (report.metamerism)
        json["metamerism"] = *report.metamerism;
    if (!report.polygons.empty())
        json["polygons"] = polygons_json(report.polygons);
    if (report.intervals)
        json["intervals"] = intervals_json(*report.intervals);
    json.update({{"nm", colour.nm},
                 {"beta_T", colour.total},
                 {"beta_R", colour.reflected},
                 {"beta_L", colour.luminescent},
                 {"warnings", report.warnings}});
    if (!colour.reason.empty())
        json["sums_reason"] = colour.reason;
    return json;
}

void test_polygons(ColourReport& report, const std::vector<ColourPolygon>& polygons) {
    if (report.observer != Observer::Cie1931Deg2)
        return;
    for (const ColourPolygon& polygon : polygons)
        if (polygon.illuminant == report.illuminant)
            report.polygons.push_back({polygon, test_polygon(polygon, report.colour)});
}

std::string report_key(const ColourReport& report, std::size_t observers) {
    return observers == 1 ? report.illuminant
                          : report.illuminant + "/" + observer_name(report.observer);
}

} // namespace reradiant
