#include "host/fit/result/fit_swatches.h"

#include "host/report/plot_frame.h"
#include "host/spectral/colour/band_sums.h"
#include "host/spectral/colour/screen_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace reradiant {

namespace {

/// The ultraviolet lamp: the same light at every wavelength between these and none elsewhere.
constexpr double ultraviolet_from_nm = 300.0, ultraviolet_to_nm = 400.0;
constexpr double visible_from_nm = 380.0, visible_to_nm = 780.0;

Spectrum ultraviolet_lamp() {
    const double middle = 0.5 * (ultraviolet_from_nm + ultraviolet_to_nm);
    const double width = ultraviolet_to_nm - ultraviolet_from_nm;
    return Spectrum::line(middle, width, width);
}

/// What was fitted as a matrix, its gaps filled from the result.
ReradiationMatrix data_matrix(const FitResult& result) {
    ReradiationMatrix data = result.matrix;
    const auto& measured = result.data.array();
    data.values = measured.isNaN().select(result.matrix.values, result.data);
    return data;
}

/// What a matrix re-radiates under the ultraviolet lamp, in any scale: its reflection is invisible.
Xyz glow(const ReradiationMatrix& matrix, const Spectrum& lamp) {
    const BandSums sums(matrix.emission, matrix.excitation, Viewing(lamp, {}), SumRange::Bands);
    return sums.sums_of(sums.exitance_of(matrix)).luminescent;
}

/// A light source's colour for the screen, divided by `brightest`.
ScreenColour screen_light(const Xyz& xyz, double brightest) {
    MatrixColour light;
    light.white = linear_srgb_to_xyz({100.0, 100.0, 100.0});
    for (std::size_t c = 0; c < 3; ++c)
        light.xyz[c] = 100.0 * xyz[c] / brightest;
    return screen_colour(light);
}

std::string field(double x, const std::string& name, const ScreenColour& colour) {
    constexpr double width = 150, top = 24, height = 90;
    std::string text = svg::text_at(x + 0.5 * width, top - 8, "middle", name);
    text += fmt::format(
        "<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" fill=\"{}\"/>\n", x,
        top, width, height, colour.hex);
    return text;
}

std::string pair_of_fields(const ScreenColour& data, const ScreenColour& fit) {
    return svg::document(300, 114, field(0, "data", data) + field(150, "fit", fit));
}

std::string clipped_text(const ScreenColour& data, const ScreenColour& fit) {
    return data.is_clipped || fit.is_clipped ? " The screen cannot show the colour as it is." : "";
}

void add_daylight(HtmlPage& page, const ReradiationMatrix& data, const ReradiationMatrix& fit) {
    const Spectrum lamp = illuminant("D65");
    const MatrixColour of_data = colour_of_matrix(data, lamp, ColourSum::Automatic);
    const MatrixColour of_fit = colour_of_matrix(fit, lamp, ColourSum::Automatic);
    const ScreenColour left = screen_colour(of_data), right = screen_colour(of_fit);
    page.figure(pair_of_fields(left, right),
                "Under D65, for the observer of 1931: data and fit." + clipped_text(left, right));
    const auto row = [](const std::string& name, const MatrixColour& colour) {
        return std::vector<std::string>{name, fmt::format("{:.2f}", colour.lab[0]),
                                        fmt::format("{:.2f}", colour.lab[1]),
                                        fmt::format("{:.2f}", colour.lab[2])};
    };
    page.table({"under D65", "L*", "a*", "b*"}, {row("data", of_data), row("fit", of_fit)});
    page.paragraph(
        fmt::format("CIEDE2000 between them: {:.3f}.", ciede2000(of_data.lab, of_fit.lab)));
}

void add_ultraviolet(HtmlPage& page, const ReradiationMatrix& data, const ReradiationMatrix& fit) {
    if (fit.excitation.centre_nm(0) > ultraviolet_to_nm)
        return;
    const Spectrum lamp = ultraviolet_lamp();
    const Xyz of_data = glow(data, lamp), of_fit = glow(fit, lamp);
    double brightest = 0.0;
    for (const Xyz& light : {of_data, of_fit})
        for (const double value : xyz_to_linear_srgb(light))
            brightest = std::max(brightest, value);
    if (!(brightest > 0.0))
        return page.paragraph("Neither re-radiates visible light under ultraviolet light.");
    const ScreenColour left = screen_light(of_data, brightest),
                       right = screen_light(of_fit, brightest);
    page.figure(
        pair_of_fields(left, right),
        fmt::format("Under a lamp of ultraviolet light alone, equal at all wavelengths from "
                    "{:.0f} to {:.0f} nm: data and fit, made as bright as the screen can, "
                    "both by the same factor.{}",
                    ultraviolet_from_nm, ultraviolet_to_nm, clipped_text(left, right)));
    const auto row = [&](const std::string& name, const Xyz& light) {
        const double sum = light[0] + light[1] + light[2];
        return std::vector<std::string>{name, fmt::format("{:.4f}", light[0] / sum),
                                        fmt::format("{:.4f}", light[1] / sum),
                                        fmt::format("{:.4f}", light[1] / of_data[1])};
    };
    page.table({"under ultraviolet light", "x", "y", "luminance over that of the data"},
               {row("data", of_data), row("fit", of_fit)});
}

} // namespace

void add_swatches(HtmlPage& page, const FitResult& result) {
    page.heading("Colours of data and fit");
    const ReradiationMatrix data = data_matrix(result);
    if (data.emission.centre_nm(0) > visible_to_nm || data.emission.to_nm() < visible_from_nm)
        return page.paragraph("No emission band is visible.");
    if (const auto gaps = (result.data.array() != result.data.array()).count(); gaps > 0)
        page.paragraph(fmt::format(
            "{} entries were not measured: the data's colours have them from the fit.", gaps));
    page.paragraph("The data count as they were measured, with noise and with reflected light that "
                   "spills over from the diagonal.");
    add_daylight(page, data, result.matrix);
    add_ultraviolet(page, data, result.matrix);
}

} // namespace reradiant
