#include "host/study/converge/converge_page.h"

#include "host/base/atomic_file.h"
#include "host/report/data_uri.h"
#include "host/report/html.h"
#include "host/report/svg.h"
#include "host/study/converge/error_image.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

/// Small films are shown enlarged, large ones reduced to this width at least and at most.
constexpr int least_picture_width = 240, most_picture_width = 480;

template <typename X, typename Y>
std::string plot(const ConvergeResult& result, const svg::Axes& axes, const X& x, const Y& y,
                 double reference_floor) {
    std::vector<svg::Series> series;
    double first = std::numeric_limits<double>::infinity(), last = 0.0;
    for (const MethodResult& method : result.methods) {
        svg::Series one{method.curve.method.name, {}, {}};
        for (const CurveRow& row : method.curve.rows) {
            one.x.push_back(x(row));
            one.y.push_back(y(row));
            first = std::min(first, one.x.back());
            last = std::max(last, one.x.back());
        }
        series.push_back(std::move(one));
    }
    if (reference_floor > 0.0 && std::isfinite(reference_floor) && last > 0.0)
        series.push_back(
            {"the reference's own error", {first, last}, {reference_floor, reference_floor}});
    return svg::line_plot(axes, series);
}

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.3g}", value) : "-";
}
std::string number(const std::optional<double>& value) {
    return value ? number(*value) : "not reached";
}

std::string floor_text(const BiasFloor& floor) {
    if (!(floor.relmse > 0.0))
        return fmt::format("none above {:.2g}", floor.smallest_visible);
    return floor.seconds ? fmt::format("{:.3g}, met at {:.3g} s", floor.relmse, *floor.seconds)
                         : fmt::format("{:.3g}, not yet met", floor.relmse);
}

std::vector<std::string> table_row(const ErrorCurve& curve, const RelmseEstimate& reference) {
    const CurveRow& last = curve.rows.back();
    return {curve.method.name,
            number(last.seconds),
            number(curve.setup_seconds),
            std::to_string(last.samples),
            number(last.error.relmse),
            number(last.error.ciede2000),
            fmt::format("{} +- {}", number(last.error.bias), number(last.error.bias_stderr)),
            number(slope_over_samples(curve)),
            number(efficiency(curve)),
            number(seconds_to_reach(curve, 1e-2)),
            number(seconds_to_reach(curve, 1e-3)),
            floor_text(bias_floor(curve, reference))};
}

void add_table(HtmlPage& page, const ConvergeResult& result) {
    page.heading("At the end of each method's time");
    std::vector<std::vector<std::string>> rows;
    for (const MethodResult& method : result.methods)
        rows.push_back(table_row(method.curve, result.reference.estimate));
    page.table({"method", "seconds", "set-up, s", "samples", "relMSE", "CIEDE2000", "bias",
                "slope of RMSE", "efficiency", "s to 1e-2", "s to 1e-3", "bias floor (relMSE)"},
               rows);
    page.paragraph("Slope of RMSE: exponent of RMSE over samples; -0.5 for independent samples. "
                   "Efficiency: 1 / (relMSE x seconds). Bias: mean over pixels and bands of image "
                   "minus reference, with its standard error. Bias floor: the part of relMSE that "
                   "neither the render's own noise nor the reference's explains, and when noise "
                   "fell below it; from there on more time gains nothing.");
}

/// A PNG as an SVG element, enlarged by whole pixels.
std::string picture(const fs::path& png, int width, int height) {
    const int shown = std::clamp(width, least_picture_width, most_picture_width);
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" "
                       "viewBox=\"0 0 {2} {3}\"><image width=\"{2}\" height=\"{3}\" "
                       "style=\"image-rendering:pixelated\" href=\"{4}\"/></svg>",
                       shown, static_cast<double>(shown) * height / width, width, height,
                       png_data_uri(png));
}

/// The next power of ten above 99 % of all errors.
double brightest_error(const std::vector<std::vector<double>>& errors) {
    double brightest = 0.0;
    for (std::vector<double> one : errors) {
        const auto place = one.begin() + static_cast<std::ptrdiff_t>(one.size() * 99 / 100);
        std::nth_element(one.begin(), place, one.end());
        brightest = std::max(brightest, *place);
    }
    return brightest > 0.0 ? std::pow(10.0, std::ceil(std::log10(brightest))) : 1.0;
}

void add_images(HtmlPage& page, const fs::path& folder, const ConvergeResult& result) {
    const SpectralImage& reference = result.reference.image;
    fs::create_directories(folder / "images");
    std::vector<std::vector<double>> errors;
    for (const MethodResult& method : result.methods)
        errors.push_back(pixel_errors(method.image, reference));
    const double brightest = brightest_error(errors);
    page.heading("Images at equal time");
    page.paragraph(fmt::format("Error images: relMSE of every pixel, from {:.0e} (dark) to {:.0e} "
                               "(light) and beyond, logarithmic.",
                               brightest * std::pow(10.0, -error_image_decades), brightest));
    const auto show = [&](const fs::path& png, const std::string& caption) {
        page.figure(picture(png, reference.width, reference.height), caption);
    };
    const fs::path reference_png = folder / "images" / "reference.png";
    write_display_png(reference_png, reference, {});
    show(reference_png, "reference");
    for (std::size_t k = 0; k < result.methods.size(); ++k) {
        const MethodResult& method = result.methods[k];
        const std::string stem = method.curve.method.file_stem();
        const fs::path png = folder / "images" / (stem + ".png");
        const fs::path error_png = folder / "images" / (stem + "-error.png");
        write_display_png(png, method.image, {});
        write_error_png(error_png, reference.width, reference.height, errors[k], brightest);
        const CurveRow& last = method.curve.rows.back();
        show(png, fmt::format("{}: {:.3g} s, {} samples", method.curve.method.name, last.seconds,
                              last.samples));
        show(error_png,
             fmt::format("{}: error, relMSE {:.3g}", method.curve.method.name, last.error.relmse));
    }
}

std::string reference_text(const Reference& reference) {
    const std::string name = reference.file.filename().string();
    if (!std::isfinite(reference.estimate.value))
        return fmt::format("The reference {} does not say its own error; bias floors count it as "
                           "none.",
                           name);
    return fmt::format("The reference {} has an estimated relMSE of {:.3g} itself, which every "
                       "curve contains.",
                       name, reference.estimate.value);
}

} // namespace

std::string curves_svg(const ConvergeResult& result) {
    return plot(
        result, {"Error over time", "seconds of rendering", "relMSE", true, true},
        [](const CurveRow& row) { return row.seconds; },
        [](const CurveRow& row) { return row.error.relmse; }, result.reference.estimate.value);
}

void write_converge_page(const fs::path& folder, const ConvergeResult& result, const Scene& scene,
                         const Device& device) {
    const std::string curves = curves_svg(result);
    write_text_atomically(folder / "error-over-time.svg", curves);
    HtmlPage page(fmt::format("Error against time: {}", scene.file.filename().string()));
    page.paragraph(fmt::format("{} x {} pixels, {} bands, on {}. Seconds are of rendering alone; "
                               "set-up stands in a column of its own. {}",
                               scene.film.width, scene.film.height,
                               result.reference.image.bands.count, device.info().name,
                               reference_text(result.reference)));
    page.figure(curves, "relMSE over the bands against time.");
    page.figure(plot(
                    result, {"With set-up", "seconds with set-up", "relMSE", true, true},
                    [](const CurveRow& row) { return row.seconds_with_setup; },
                    [](const CurveRow& row) { return row.error.relmse; },
                    result.reference.estimate.value),
                "The same with tables and kernels made first (kernels may come from the cache).");
    page.figure(plot(
                    result, {"Colour difference over time", "seconds", "CIEDE2000", true, true},
                    [](const CurveRow& row) { return row.seconds; },
                    [](const CurveRow& row) { return row.error.ciede2000; }, 0.0),
                "Mean CIEDE2000 of pixels against D65.");
    page.figure(plot(
                    result, {"RMSE over samples", "samples a pixel", "RMSE", true, true},
                    [](const CurveRow& row) { return static_cast<double>(row.samples); },
                    [](const CurveRow& row) { return row.error.rmse; }, 0.0),
                "Independent samples fall with slope -0.5.");
    add_table(page, result);
    add_images(page, folder, result);
    write_text_atomically(folder / "index.html", page.text());
}

} // namespace reradiant
