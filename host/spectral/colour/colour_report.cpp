#include "host/spectral/colour/colour_report.h"

#include <cmath>

namespace reradiant {

std::size_t ColourReport::brightest_band() const {
    std::size_t best = 0;
    for (std::size_t o = 0; o < colour.total.size(); ++o)
        if (!(colour.total[o] <= colour.total[best]) && !std::isnan(colour.total[o]))
            best = o;
    return best;
}

ColourReport colour_report(const ReradiationMatrix& matrix, const std::string& name,
                           const Spectrum& illuminant, ColourSum sum) {
    ColourReport report{.illuminant = name,
                        .colour = colour_of_matrix(matrix, illuminant, sum),
                        .whiteness = {},
                        .ciede2000 = {},
                        .polygons = {},
                        .warnings = colour_warnings(matrix, illuminant, name)};
    if (name == "D65" || name == "C")
        report.whiteness = cie_whiteness(report.colour.xyz, report.colour.white);
    return report;
}

nlohmann::ordered_json colour_report_json(const ColourReport& report) {
    const MatrixColour& colour = report.colour;
    const std::size_t brightest = report.brightest_band();
    nlohmann::ordered_json json = {
        {"XYZ", colour.xyz},
        {"xy", colour.xy},
        {"Lab", colour.lab},
        {"white_XYZ", colour.white},
        {"sums", colour.at_nanometres ? "1 nm" : "bands"},
        {"luminance_factor",
         {{"total", colour.xyz[1] / 100.0},
          {"reflected", colour.luminance_reflected / 100.0},
          {"luminescent", (colour.xyz[1] - colour.luminance_reflected) / 100.0}}},
        {"largest_beta_T", {{"value", colour.total[brightest]}, {"nm", colour.nm[brightest]}}}};
    if (report.whiteness)
        json.update({{"whiteness", report.whiteness->whiteness},
                     {"tint", report.whiteness->tint},
                     {"whiteness_within_limits", report.whiteness->within_limits}});
    if (report.ciede2000)
        json["ciede2000"] = *report.ciede2000;
    for (const PolygonVerdict& verdict : report.polygons)
        json["polygons"].push_back({{"name", verdict.polygon.name},
                                    {"passes", verdict.result.passes()},
                                    {"chromaticity", verdict.result.chromaticity},
                                    {"luminance_factor", verdict.result.luminance_factor}});
    json.update({{"nm", colour.nm},
                 {"beta_T", colour.total},
                 {"beta_R", colour.reflected},
                 {"beta_L", colour.luminescent},
                 {"warnings", report.warnings}});
    if (!colour.reason.empty())
        json["sums_reason"] = colour.reason;
    return json;
}

} // namespace reradiant
