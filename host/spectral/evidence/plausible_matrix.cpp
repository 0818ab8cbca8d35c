#include "host/spectral/evidence/plausible_matrix.h"

#include "host/base/output_ending.h"
#include "host/spectral/evidence/matrix_evidence.h"
#include "host/spectral/files/matrix_csv_header.h"
#include "host/spectral/text/text_reader.h"
#include "reradiant/error.h"
#include "reradiant/spectral_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>
#include <vector>

namespace reradiant {

namespace {

constexpr double shortest_nm = 100.0, longest_nm = 3000.0;
constexpr double largest_value = 10.0, largest_median_energy = 2.0;
constexpr std::size_t most_cells = std::numeric_limits<std::size_t>::max();
constexpr const char* remedy =
    "values have unit 1; write '# unit: percent', or `reradiant convert` with --scale percent";

/// Line and column of the first number of a CSV that is beyond the limit.
SourcePosition place_of_large_value(const std::filesystem::path& file) {
    std::error_code ignored;
    if (lower_case_ending(file) != ".csv" || !std::filesystem::exists(file, ignored))
        return {file.string()};
    TextReader reader(file);
    std::size_t first = 0, end = 0; // cells of a row that hold values; none before the headings
    for (std::string_view line; reader.next_line(line);) {
        if (!is_line_of_cells(line))
            continue;
        const std::vector<TextToken> tokens = table_cells(reader, line);
        if (end == 0) {
            // Long forms name the column of their values, behind which their errors follow.
            const bool is_measurement = tokens[0].text == "theta_i_deg";
            if (!is_measurement && heading_kind(tokens, next_cells(reader)) == HeadingKind::Title)
                continue;
            const bool is_long = is_measurement || names_long_form(tokens);
            const auto value =
                std::find_if(tokens.begin(), tokens.end(), [](const TextToken& heading) {
                    return long_role(heading.text) == LongRole::Value;
                });
            first = is_long ? static_cast<std::size_t>(value - tokens.begin()) : 1;
            end = is_measurement ? tokens.size() : is_long ? first + 1 : most_cells;
            continue;
        }
        for (std::size_t k = first; k < std::min(end, tokens.size()); ++k)
            if (!is_gap(tokens[k].text) && is_number(tokens[k].text) &&
                std::abs(reader.number(tokens[k])) > largest_value)
                return reader.position(tokens[k]);
    }
    return {file.string()};
}

/// Energy that each excitation band sends out over what it receives, gaps left out.
std::vector<double> energies(const ReradiationMatrix& matrix) {
    ReradiationMatrix whole = matrix;
    whole.values = matrix.values.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
    return column_balance(whole).radiant;
}

} // namespace

void require_plausible_bands(const WavelengthGrid& emission, const WavelengthGrid& excitation,
                             const std::filesystem::path& file) {
    for (const WavelengthGrid* grid : {&emission, &excitation})
        if (grid->from_nm < shortest_nm || grid->to_nm() > longest_nm)
            throw_input_error({file.string(), file.empty() ? 0 : 1, 1},
                              fmt::format("wavelengths from {:.6g} to {:.6g} cannot be in nm",
                                          grid->from_nm, grid->to_nm()),
                              fmt::format("give nm, {} to {}", shortest_nm, longest_nm));
}

void require_plausible_values(const Eigen::MatrixXd& values, const std::filesystem::path& file) {
    double largest = 0.0;
    for (const double value : values.reshaped())
        if (std::isfinite(value))
            largest = std::max(largest, std::abs(value));
    if (largest > largest_value)
        throw_input_error(place_of_large_value(file),
                          fmt::format("a radiance factor of {:.6g} in one band cannot be", largest),
                          remedy);
}

void require_plausible_matrix(const ReradiationMatrix& matrix, const std::filesystem::path& file) {
    require_plausible_bands(matrix.emission, matrix.excitation, file);
    require_plausible_values(matrix.values, file);
    std::vector<double> energy = energies(matrix);
    const auto middle = energy.begin() + static_cast<std::ptrdiff_t>(energy.size() / 2);
    std::nth_element(energy.begin(), middle, energy.end());
    if (*middle <= largest_median_energy)
        return;
    const bool is_density = was_taken_as_density(evidence_of(matrix), matrix.excitation.step_nm);
    throw_input_error({file.string(), file.empty() ? 0 : 1, 1},
                      fmt::format("excitation bands return {:.6g} times the energy that they "
                                  "receive, in the median",
                                  *middle),
                      is_density ? "the values are probably per band and were taken as per nm: "
                                   "declare '# quantity: per-band'"
                                 : remedy);
}

} // namespace reradiant
