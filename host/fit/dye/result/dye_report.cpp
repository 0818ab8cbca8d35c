#include "host/fit/dye/result/dye_report.h"

#include "host/base/atomic_file.h"
#include "host/fit/dye/result/dye_summary.h"
#include "host/report/html.h"
#include "host/report/svg.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double normal_95 = 1.959963984540054;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::vector<double> list_of(const Vector& values) {
    return {values.data(), values.data() + values.size()};
}

svg::Series banded(const std::string& label, const DyeFitResult& result, const Vector& value,
                   const Vector& sigma) {
    svg::Series series{label, result.bands.centres_nm(), list_of(value)};
    series.low = list_of((value - normal_95 * sigma).cwiseMax(0.0));
    series.high = list_of(value + normal_95 * sigma);
    return series;
}

void add_spectra(HtmlPage& page, const DyeFitResult& result) {
    page.heading("The dyes, with 95 % bands");
    std::vector<svg::Series> absorption, emission;
    for (std::size_t k = 0; k < result.dyes.size(); ++k) {
        const FittedDye& dye = result.dyes[k];
        const std::string label = fmt::format("dye {}", k + 1);
        absorption.push_back(banded(label, result, dye.absorption, dye.absorption_sigma));
        emission.push_back(banded(label, result, dye.emission, dye.emission_sigma));
    }
    page.figure(svg::line_plot({"absorption", "nm", "per unit of thickness"}, absorption),
                "Natural logarithm, at concentration 1.");
    page.figure(svg::line_plot({"emission", "nm", "1/nm"}, emission),
                "Power; bands in which the data show none are dark, with their error.");
    if (result.reflectance.size() > 0)
        page.figure(
            svg::line_plot({"substrate", "nm", "reflectance"},
                           {banded("", result, result.reflectance, result.reflectance_sigma)}),
            "Fitted.");
}

void add_yields(HtmlPage& page, const DyeFitResult& result) {
    page.heading("Quantum yield");
    std::vector<std::vector<std::string>> rows;
    for (std::size_t k = 0; k < result.dyes.size(); ++k) {
        const BandedNumber& yield = result.dyes[k].quantum_yield;
        rows.push_back({fmt::format("dye {}", k + 1), fmt::format("{:.4f}", yield.value),
                        fmt::format("{:.4f}", yield.low), fmt::format("{:.4f}", yield.high)});
    }
    if (std::isfinite(result.inner_filter_yield))
        rows.push_back({"inner-filter correction alone, over black",
                        fmt::format("{:.4f}", result.inner_filter_yield)});
    page.table({"photons sent out / photons absorbed by the dye", "", "95 % from", "to"}, rows);
    page.paragraph(
        "What is absorbed again and sent out again is counted in the yields of the dyes; "
        "the usual correction leaves it out.");
}

svg::HeatMap map_of(const FittedDyeData& set, const std::string& title, const Matrix& value) {
    svg::HeatMap map;
    map.title = title;
    map.x_label = "excitation, nm";
    map.y_label = "emission, nm";
    map.x = set.data.excitation.centres_nm();
    map.y = set.data.emission.centres_nm();
    map.value = value;
    return map;
}

/// Root of the mean square of what is left in every excitation band.
Vector residuals_by_excitation(const Matrix& residual, const Matrix& used) {
    Vector rms(residual.cols());
    for (Eigen::Index i = 0; i < rms.size(); ++i) {
        const double count = used.col(i).sum();
        rms(i) =
            count > 0.0
                ? std::sqrt(residual.col(i).cwiseAbs2().cwiseProduct(used.col(i)).sum() / count)
                : nan_value;
    }
    return rms;
}

void add_set(HtmlPage& page, const FittedDyeData& set) {
    page.heading(set.data.file.filename().string());
    page.paragraph(fmt::format("{} entries are masked ({}), {} saturated.", set.mask.measured,
                               mask_rules_text(set.mask.rules), set.saturated));
    for (std::size_t b = 0; b < set.model.size(); ++b) {
        const Matrix& used = set.used[b];
        const Matrix gaps = Matrix::Constant(used.rows(), used.cols(), nan_value);
        // the diagonal, which is reflected light, would outshine the rest
        Matrix shown = set.data.blocks[b].value;
        for (int i = 0; i < set.data.excitation.count; ++i)
            for (int o = 0; o < set.data.emission.count; ++o)
                if (set.data.emission.centre_nm(o) <= set.data.excitation.centre_nm(i))
                    shown(o, i) = nan_value;
        svg::HeatMap map = map_of(set, "data", shown);
        map.marked = set.mask.entries;
        page.figure(svg::heat_map(map), "As measured; outlined entries are masked.");
        const Matrix residual =
            (used.array() > 0.0).select(set.model[b] - set.data.blocks[b].value, gaps);
        map = map_of(set, "model - data", residual);
        map.diverging = true;
        page.figure(svg::heat_map(map), "Entries that took part.");
        const Vector rms = residuals_by_excitation(
            (used.array() > 0.0).select(set.model[b] - set.data.blocks[b].value, 0.0), used);
        page.figure(svg::line_plot({"residuals by excitation", "nm", "rms"},
                                   {{"", set.data.excitation.centres_nm(), list_of(rms)}}),
                    "");
    }
}

} // namespace

void write_dye_report(const std::filesystem::path& file, const DyeFitResult& result) {
    HtmlPage page("Dyes of " + result.sets.front().data.file.filename().string());
    for (const std::string& sentence : dye_sentences(result))
        page.paragraph(sentence + ".");
    page.paragraph(fmt::format("Reduced chi squared {:.4g}; {} iterations: {}.",
                               result.reduced_chi_squared, result.trace.iterations,
                               result.trace.stop_reason));
    if (!result.shortfall.empty())
        page.paragraph("Not done: " + result.shortfall + ".");
    for (const std::string& warning : result.warnings)
        page.paragraph("Warning: " + warning + ".");
    for (const std::string& note : result.notes)
        page.paragraph(note + ".");
    add_spectra(page, result);
    add_yields(page, result);
    for (const FittedDyeData& set : result.sets)
        add_set(page, set);
    write_text_atomically(file, page.text());
}

} // namespace reradiant
