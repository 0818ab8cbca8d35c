/// What happens to the hue of a thousand saturated colours that a display does not show, clipped
/// and compressed: a row a range of hues, and, where a file is named, a plot.

#include "host/base/atomic_file.h"
#include "host/film/display/display_gamut.h"
#include "host/report/svg.h"
#include "tests/film/saturated_colours.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace reradiant;
using namespace reradiant::test;

namespace {

constexpr int ranges = 18;
constexpr double range_deg = 360.0 / ranges;

struct Range {
    std::array<std::vector<double>, 2> error_deg; ///< clipped, compressed
};

double hue_deg(const Xyz& xyz) {
    const auto lab = xyz_to_lab(xyz, srgb_white());
    const double angle = std::atan2(lab[2], lab[1]) * 180.0 / 3.14159265358979323846;
    return angle < 0.0 ? angle + 360.0 : angle;
}

std::array<Range, ranges> errors_by_hue() {
    const DisplayGamut gamut(srgb_primaries());
    std::array<Range, ranges> result;
    for (const Xyz& colour : saturated_colours()) {
        const auto index = static_cast<std::size_t>(hue_deg(colour) / range_deg) % ranges;
        result[index].error_deg[0].push_back(hue_error(colour, clipped_to_srgb(colour)).angle_deg);
        result[index].error_deg[1].push_back(hue_error(colour, gamut.compressed(colour)).angle_deg);
    }
    return result;
}

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

} // namespace

int main(int count, char** arguments) {
    std::vector<svg::Series> series = {{.label = "clip", .x = {}, .y = {}},
                                       {.label = "compress", .x = {}, .y = {}}};
    fmt::print("| hue of CIELAB, degrees | colours | clip: mean error | compress |\n"
               "| --- | --- | --- | --- |\n");
    const auto errors = errors_by_hue();
    for (std::size_t index = 0; index < errors.size(); ++index) {
        const auto& error_deg = errors[index].error_deg;
        if (error_deg[0].empty())
            continue;
        const double from = range_deg * static_cast<double>(index);
        for (std::size_t way = 0; way < series.size(); ++way) {
            series[way].x.push_back(from + 0.5 * range_deg);
            series[way].y.push_back(mean(error_deg[way]));
            series[way].low.push_back(quantile(error_deg[way], 0.1));
            series[way].high.push_back(quantile(error_deg[way], 0.9));
        }
        fmt::print("| {:.0f} to {:.0f} | {} | {:.1f} | {:.1f} |\n", from, from + range_deg,
                   error_deg[0].size(), mean(error_deg[0]), mean(error_deg[1]));
    }
    if (count > 1)
        write_text_atomically(
            arguments[1], svg::line_plot({.title = "A thousand saturated colours: mean and 80 %",
                                          .x_label = "hue of CIELAB / degrees",
                                          .y_label = "error of the hue / degrees"},
                                         series));
    return 0;
}
