#include "tools/commands/colour/colour_print.h"

#include "host/spectral/covariance/colour_intervals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

void print_polygons(const ColourReport& report) {
    for (const PolygonVerdict& verdict : report.polygons)
        fmt::print("  {}: {} (chromaticity {}, luminance factor {:.4f} {} {})\n",
                   verdict.polygon.name, verdict.result.passes() ? "passes" : "fails",
                   verdict.result.chromaticity ? "inside" : "outside", report.colour.xyz[1] / 100.0,
                   verdict.result.luminance_factor ? "of at least" : "is under",
                   verdict.polygon.minimum_luminance_factor);
}

/// Radiance factors: total = reflected + luminescent.
void print_table(const MatrixColour& colour) {
    fmt::print("  {:>7} {:>9} {:>9} {:>9}\n", "nm", "beta_T", "beta_R", "beta_L");
    for (std::size_t o = 0; o < colour.nm.size(); ++o)
        fmt::print("  {:>7.6g} {:>9.5f} {:>9.5f} {:>9.5f}\n", colour.nm[o], colour.total[o],
                   colour.reflected[o], colour.luminescent[o]);
}

/// The indices that are defined here, on a line each.
void print_indices(const IndexedColour& of) {
    if (of.whiteness)
        fmt::print("  whiteness {:.2f}, tint {:.2f}{}\n", of.whiteness->whiteness,
                   of.whiteness->tint,
                   of.whiteness->within_limits ? "" : " (no white: outside the limits)");
    if (of.r457)
        fmt::print("  brightness R457 {:.2f}\n", *of.r457);
    if (of.e313)
        fmt::print("  E313 whiteness {:.2f}, yellowness {:.2f}\n", of.e313->whiteness,
                   of.e313->yellowness);
}

/// Intervals by linearisation, and how far those of drawn matrices are from them.
void print_intervals(const std::optional<ColourIntervals>& intervals) {
    if (!intervals)
        return;
    double apart = 0.0; // standard errors
    for (std::size_t k = 0; k < intervals->linearised.size(); ++k) {
        const QuantityInterval &one = intervals->linearised[k], &other = intervals->drawn[k];
        std::string line;
        for (std::size_t c = 0; c < one.low.size(); ++c) {
            line += fmt::format("{} {:.4f} to {:.4f}", c > 0 ? "," : "", one.low[c], one.high[c]);
            for (const double off : {one.low[c] - other.low[c], one.high[c] - other.high[c]})
                apart = std::max(apart, std::abs(off) / one.standard_error[c]);
        }
        fmt::print("  95 % of {}:{}\n", one.name, line);
    }
    fmt::print("  {} drawn matrices: ends within {:.2f} standard errors of these\n", drawn_matrices,
               apart);
}

/// What ultraviolet light adds.
void print_without_ultraviolet(const ColourReport& report) {
    const IndexedColour& without = report.uv_excluded;
    fmt::print("  without excitation below {:.6g} nm: Lab {:.4f} {:.4f} {:.4f}",
               uv_excluded_from_nm, without.colour.lab[0], without.colour.lab[1],
               without.colour.lab[2]);
    if (without.whiteness)
        fmt::print(", whiteness {:.2f}", without.whiteness->whiteness);
    if (without.r457)
        fmt::print(", R457 {:.2f}", *without.r457);
    fmt::print("\n  {:.2f} % of the lamp's irradiance lies below 400 nm\n",
               100.0 * report.ultraviolet_share);
}

void print_differences(const ColourReport& report, const std::string& from) {
    if (report.differences)
        fmt::print(
            "  CIEDE2000 {:.4f}, CIE 1976 {:.4f}, CIE 1994 {:.4f}, CMC(2:1) {:.4f} from {}\n",
            report.differences->ciede2000, report.differences->cie1976, report.differences->cie1994,
            report.differences->cmc21, from);
    if (report.metamerism)
        fmt::print("  metamerism index {:.4f}\n", *report.metamerism);
}

} // namespace

void print_colour(const ColourReport& report, const ColourOptions& options) {
    const MatrixColour& colour = report.colour;
    const std::size_t brightest = report.brightest_band();
    fmt::print("{}\n", key_of(report, options));
    if (!colour.reason.empty())
        fmt::print("  {}\n", colour.reason);
    fmt::print("  XYZ  {:.4f} {:.4f} {:.4f}\n", colour.xyz[0], colour.xyz[1], colour.xyz[2]);
    fmt::print("  xy   {:.5f} {:.5f}\n", colour.xy[0], colour.xy[1]);
    fmt::print("  Lab  {:.4f} {:.4f} {:.4f}\n", colour.lab[0], colour.lab[1], colour.lab[2]);
    fmt::print("  LCh  {:.4f} {:.4f} {:.4f}\n", report.lch[0], report.lch[1], report.lch[2]);
    fmt::print("  luminance factor {:.4f} = {:.4f} reflected + {:.4f} re-radiated\n",
               colour.xyz[1] / 100.0, colour.luminance_reflected / 100.0,
               (colour.xyz[1] - colour.luminance_reflected) / 100.0);
    if (std::isfinite(colour.total[brightest]))
        fmt::print("  largest total radiance factor {:.4f} at {:.6g} nm\n", colour.total[brightest],
                   colour.nm[brightest]);
    print_indices(report);
    print_intervals(report.intervals);
    print_without_ultraviolet(report);
    print_differences(report, options.against.string());
    print_polygons(report);
    if (options.table)
        print_table(colour);
}

} // namespace reradiant
