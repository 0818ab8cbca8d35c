#include "host/fit/data/fit_mask.h"

#include "host/spectral/evidence/scatter_detection.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

Matrix entries_in(const MaskBox& box, const WavelengthGrid& emission,
                  const WavelengthGrid& excitation) {
    const auto within = [](double nm, double from, double to, double step) {
        return nm >= from - 1e-6 * step && nm <= to + 1e-6 * step;
    };
    Matrix in(emission.count, excitation.count);
    for (int i = 0; i < excitation.count; ++i)
        for (int o = 0; o < emission.count; ++o)
            in(o, i) = within(excitation.centre_nm(i), box.excitation_from_nm, box.excitation_to_nm,
                              excitation.step_nm) &&
                               within(emission.centre_nm(o), box.emission_from_nm,
                                      box.emission_to_nm, emission.step_nm)
                           ? 1.0
                           : 0.0;
    return in;
}

/// 1 where a block was measured.
Matrix measured_entries(const BispectralData& data) {
    Matrix measured = Matrix::Zero(data.emission.count, data.excitation.count);
    for (const BispectralBlock& block : data.blocks)
        measured =
            measured.cwiseMax((block.value.array() == block.value.array()).cast<double>().matrix());
    return measured;
}

Matrix off_diagonal(const BispectralData& data) {
    Matrix off = Matrix::Ones(data.emission.count, data.excitation.count);
    for (int i = 0; i < data.excitation.count; ++i)
        for (int o = 0; o < data.emission.count; ++o)
            off(o, i) = on_diagonal(data.emission, o, data.excitation, i) ? 0.0 : 1.0;
    return off;
}

/// Lines that stand out of any block, each as wide as where it is widest.
std::vector<FoundScatter> found_in(const BispectralData& data, const ScatterSettings& scatter) {
    std::vector<FoundScatter> all;
    ReradiationMatrix matrix;
    matrix.emission = data.emission;
    matrix.excitation = data.excitation;
    for (const BispectralBlock& block : data.blocks) {
        matrix.values = block.value;
        for (const FoundScatter& found : find_scatter(matrix, scatter)) {
            const auto same = std::find_if(all.begin(), all.end(), [&](const FoundScatter& other) {
                return other.line.order == found.line.order;
            });
            if (same == all.end())
                all.push_back(found);
            else if (found.line.half_width_nm > same->line.half_width_nm)
                *same = found;
        }
    }
    return all;
}

/// Adds the entries of one rule.
void add(const Matrix& entries, const std::string& rule, const Matrix& measured, FitMask& mask) {
    if (entries.cwiseProduct(measured).sum() == 0.0)
        mask.warnings.push_back(fmt::format("--mask {}: no measured entry lies there", rule));
    mask.entries = mask.entries.cwiseMax(entries);
}

void add_found_lines(const BispectralData& data, const ScatterSettings& scatter, FitMask& mask) {
    for (const FoundScatter& found : found_in(data, scatter)) {
        if (std::any_of(mask.rules.lines.begin(), mask.rules.lines.end(),
                        [&](const ScatterLine& line) { return line.order == found.line.order; }))
            continue;
        mask.found.push_back(found);
        mask.rules.lines.push_back(found.line);
        mask.notes.push_back(fmt::format("{} stands out and is taken as not measured; --mask none "
                                         "keeps it",
                                         scatter_text(found)));
    }
}

} // namespace

FitMask mask_of(const BispectralData& data, const MaskRules& rules,
                const ScatterSettings& scatter) {
    FitMask mask;
    mask.rules = rules;
    if (rules.automatic)
        add_found_lines(data, scatter, mask);
    if (mask.rules.lines.empty() && mask.rules.boxes.empty())
        return mask;
    const Matrix measured = measured_entries(data);
    mask.entries = Matrix::Zero(measured.rows(), measured.cols());
    for (const ScatterLine& line : mask.rules.lines)
        add(entries_on(line, data.emission, data.excitation), mask_rules_text({false, {line}, {}}),
            measured, mask);
    for (const MaskBox& box : mask.rules.boxes)
        add(entries_in(box, data.emission, data.excitation), mask_rules_text({false, {}, {box}}),
            measured, mask);
    mask.measured = static_cast<int>(mask.entries.cwiseProduct(measured).sum());
    const Matrix left = measured.cwiseProduct(off_diagonal(data));
    if (mask.any() && (left - left.cwiseProduct(mask.entries)).sum() == 0.0)
        throw_input_error(
            {data.file.string()},
            fmt::format("--mask {} leaves no entry off the diagonal", mask_rules_text(mask.rules)),
            "give narrower rules");
    if (rules != MaskRules{} && mask.any())
        mask.notes.push_back(fmt::format("{} entries are taken as not measured: --mask {}",
                                         mask.measured, mask_rules_text(rules)));
    return mask;
}

BispectralData with_gaps(BispectralData data, const FitMask& mask) {
    if (!mask.any())
        return data;
    for (BispectralBlock& block : data.blocks)
        for (Eigen::Index k = 0; k < mask.entries.size(); ++k)
            if (mask.entries(k) > 0.0)
                block.value(k) = block.sigma(k) = std::numeric_limits<double>::quiet_NaN();
    return data;
}

} // namespace reradiant
