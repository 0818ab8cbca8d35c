#include "host/fit/result/fit_report.h"

#include "host/base/atomic_file.h"
#include "host/fit/result/fit_swatches.h"
#include "host/report/html.h"
#include "host/report/svg.h"
#include "host/spectral/evidence/scatter_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <sys/resource.h>

namespace reradiant {

namespace {

constexpr double normal_95 = 1.959963984540054;

double peak_memory_mib() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0; // kilobytes on Linux
}

std::vector<double> list_of(const Eigen::VectorXd& values) {
    return {values.data(), values.data() + values.size()};
}

std::string functions_text(const FitResult& result) {
    if (!result.emission_knots_nm.empty())
        return fmt::format("linear between values at emission {} nm and excitation {} nm",
                           fmt::join(result.emission_knots_nm, ", "),
                           fmt::join(result.excitation_knots_nm, ", "));
    return result.spacing_nm > 0.0 ? fmt::format("splines every {} nm", result.spacing_nm)
                                   : "one number a band";
}

void add_numbers(HtmlPage& page, const BispectralData& data, const FitResult& result) {
    std::vector<std::vector<std::string>> rows = {
        {"data", data.file.string()},
        {"model", fit_model_name(result.model)},
        {"terms", std::to_string(result.rank)},
        {"bytes of the compact form", std::to_string(result.bytes)},
        {"relative RMSE (emission more than one band above the excitation)",
         fmt::format("{:.5f}", result.relative_rmse)},
        {"RMSE of the fitted entries", fmt::format("{:.4g}", result.rmse)},
        {result.noise_is_estimated ? "noise (estimated)" : "noise (given)",
         fmt::format("{:.4g}", result.noise)},
        {"reduced chi squared (1 where only noise is left)",
         fmt::format("{:.4g}", result.reduced_chi_squared)},
        {"why it stopped", result.trace.stop_reason},
        {"distance from a minimum (violation of the KKT conditions)",
         fmt::format("{:.2g}", result.trace.kkt)},
        {"iterations", std::to_string(result.trace.iterations)},
        {"numbers of the model that the data determine",
         fmt::format("{} of {}", result.covariance_rank, result.parameters)},
        {"anti-Stokes energy", fmt::format("{:.3g}", result.anti_stokes_energy)},
        {"peak memory", fmt::format("{:.0f} MiB", peak_memory_mib())}};
    if (!result.trace.seconds.empty())
        rows.push_back({"seconds", fmt::format("{:.2f}", result.trace.seconds.back())});
    if (result.model == FitModel::Factors && result.rank > 0)
        rows.push_back({"emission and excitation are", functions_text(result)});
    page.table({"", ""}, rows);
    if (!result.shortfall.empty())
        page.paragraph("Not done: " + result.shortfall + ".");
    for (const std::string& warning : result.warnings)
        page.paragraph("Warning: " + warning + ".");
    for (const std::string& note : result.notes)
        page.paragraph(note + ".");
}

void add_yields(HtmlPage& page, const FitResult& result) {
    if (result.quantum_yield.empty())
        return;
    page.heading("Quantum yield");
    std::vector<std::vector<std::string>> rows;
    for (std::size_t k = 0; k < result.quantum_yield.size(); ++k) {
        const QuantumYield& yield = result.quantum_yield[k];
        if (!std::isfinite(yield.value)) {
            rows.push_back({std::to_string(k + 1), "unknown", "", ""});
            continue;
        }
        rows.push_back({std::to_string(k + 1), fmt::format("{:.4f}", yield.value),
                        fmt::format("{:.4f}", yield.low), fmt::format("{:.4f}", yield.high)});
    }
    page.table({"term", "photons emitted / photons absorbed by the sample", "95 % from", "to"},
               rows);
    page.paragraph("The sample absorbs what its diagonal does not reflect, by its dye or by "
                   "anything else. The yield of the dye itself, of the photons that the dye "
                   "absorbs, is as high or higher: the data cannot tell who absorbed a photon.");
}

void add_stack(HtmlPage& page, const FitResult& result) {
    if (!result.stack)
        return;
    const StackEstimate& stack = *result.stack;
    page.heading("Unknown numbers of the stack");
    std::vector<std::string> header{"", "value", "standard error"};
    header.insert(header.end(), stack.names.begin(), stack.names.end());
    std::vector<std::vector<std::string>> rows;
    for (std::size_t k = 0; k < stack.names.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        std::vector<std::string> row{stack.names[k], fmt::format("{:.6g}", stack.value(at)),
                                     fmt::format("{:.3g}", stack.sigma(at))};
        for (Eigen::Index j = 0; j < stack.correlation.cols(); ++j)
            row.push_back(fmt::format("{:.4f}", stack.correlation(at, j)));
        rows.push_back(row);
    }
    page.table(header, rows);
    page.paragraph(fmt::format("The data determine {} of {} numbers; reduced chi squared {:.4g}. "
                               "The last columns are correlations.",
                               stack.rank, stack.names.size(), stack.reduced_chi_squared));
    for (const std::string& ambiguity : stack.ambiguities)
        page.paragraph(ambiguity + ".");
}

/// The first block as it was measured, without its diagonal, which would outshine the rest.
void add_mask(HtmlPage& page, const BispectralData& data, const FitResult& result) {
    if (!result.mask.any())
        return;
    page.heading("Mask");
    svg::HeatMap map;
    map.title = "data as measured";
    map.x_label = "excitation, nm";
    map.y_label = "emission, nm";
    map.x = data.excitation.centres_nm();
    map.y = data.emission.centres_nm();
    map.value = data.blocks.front().value;
    for (int i = 0; i < data.excitation.count; ++i)
        for (int o = 0; o < data.emission.count; ++o)
            if (on_diagonal(data.emission, o, data.excitation, i))
                map.value(o, i) = std::numeric_limits<double>::quiet_NaN();
    map.marked = result.mask.entries;
    page.figure(svg::heat_map(map),
                fmt::format("Outlined entries count as not measured: --mask {}.",
                            mask_rules_text(result.mask.rules)));
}

void add_maps(HtmlPage& page, const FitResult& result) {
    page.heading("Data, model, residuals");
    const Eigen::MatrixXd gaps = Eigen::MatrixXd::Constant(
        result.data.rows(), result.data.cols(), std::numeric_limits<double>::quiet_NaN());
    const Eigen::MatrixXd used = (result.used.array() > 0.0).select(result.data, gaps);
    svg::HeatMap map;
    map.x_label = "excitation, nm";
    map.y_label = "emission, nm";
    map.x = result.matrix.excitation.centres_nm();
    map.y = result.matrix.emission.centres_nm();
    map.title = "data";
    map.value = used;
    page.figure(svg::heat_map(map), "What was fitted; hatched entries took no part.");
    map.title = "model";
    map.value = result.matrix.fluorescent_part();
    page.figure(svg::heat_map(map), "The fluorescent part of the result.");
    map.title = "model - data";
    map.value = result.matrix.fluorescent_part() - used;
    map.diverging = true;
    page.figure(svg::heat_map(map), "Residuals of the entries that took part.");
}

svg::Series banded(const std::string& label, const std::vector<double>& nm,
                   const Eigen::VectorXd& value, const Eigen::VectorXd& sigma) {
    svg::Series series{label, nm, list_of(value)};
    series.low = list_of((value - normal_95 * sigma).cwiseMax(0.0));
    series.high = list_of(value + normal_95 * sigma);
    return series;
}

void add_curves(HtmlPage& page, const FitResult& result) {
    page.heading("Curves with 95 % bands");
    const auto plot = [&](const FittedCurves& curves, const WavelengthGrid& grid,
                          const std::string& title, const std::string& unit) {
        if (curves.value.cols() == 0)
            return;
        std::vector<svg::Series> series;
        for (Eigen::Index k = 0; k < curves.value.cols(); ++k)
            series.push_back(banded(fmt::format("term {}", k + 1), grid.centres_nm(),
                                    curves.value.col(k), curves.sigma.col(k)));
        page.figure(svg::line_plot({title, "nm", unit}, series), "");
    };
    plot(result.emission, result.matrix.emission, "emission", "1/nm");
    plot(result.excitation, result.matrix.excitation, "excitation", "share of the irradiance");
    Eigen::VectorXd diagonal(result.matrix.excitation.count), sigma = diagonal;
    diagonal.setConstant(std::numeric_limits<double>::quiet_NaN());
    sigma.setZero();
    for (int i = 0; i < result.matrix.excitation.count; ++i)
        if (const int o = diagonal_row(result.matrix, i); o >= 0) {
            diagonal(i) = result.matrix.values(o, i);
            sigma(i) = std::isfinite(result.sigma(o, i)) ? result.sigma(o, i) : 0.0;
        }
    page.figure(
        svg::line_plot({"diagonal", "nm", "reflectance"},
                       {banded("", result.matrix.excitation.centres_nm(), diagonal, sigma)}),
        "Passed through from the data.");
}

void add_convergence(HtmlPage& page, const FitResult& result) {
    if (result.trace.cost.empty())
        return;
    page.heading("Convergence");
    std::vector<double> steps;
    for (std::size_t k = 0; k < result.trace.cost.size(); ++k)
        steps.push_back(static_cast<double>(k));
    svg::Axes axes{"cost", "step", "half chi squared"};
    axes.log_y = true;
    page.figure(
        svg::line_plot(axes, {{"", steps, result.trace.cost}}),
        "Every step of every round; rounds begin where the set of numbers at zero changes.");
    axes.x_label = "seconds";
    page.figure(svg::line_plot(axes, {{"", result.trace.seconds, result.trace.cost}}), "");
}

} // namespace

void write_fit_report(const std::filesystem::path& file, const BispectralData& data,
                      const FitResult& result) {
    HtmlPage page("Re-radiation matrix of " + data.file.filename().string());
    add_numbers(page, data, result);
    add_yields(page, result);
    add_stack(page, result);
    add_mask(page, data, result);
    add_swatches(page, result);
    add_maps(page, result);
    add_curves(page, result);
    add_convergence(page, result);
    write_text_atomically(file, page.text());
}

} // namespace reradiant
