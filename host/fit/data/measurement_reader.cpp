#include "host/fit/data/measurement_reader.h"

#include "host/spectral/files/matrix_csv_header.h"
#include "host/spectral/files/matrix_formats.h"
#include "host/spectral/text/text_reader.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>

namespace reradiant {

namespace {

constexpr std::string_view headings =
    "theta_i_deg,theta_o_deg,phi_deg,lambda_i_nm,lambda_o_nm,value,stderr,part";
constexpr std::size_t column_count = 8;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

struct Row {
    PlacedWavelength emission, excitation;
    double value, sigma;
    bool is_of_slab = false;
};
using Directions = std::tuple<double, double, double>; // theta_i, theta_o, phi in degrees
using RowsByDirections = std::map<Directions, std::vector<Row>>;

void refuse_other_unit(const TextReader& reader, const TextToken& value) {
    const std::string unit = lower_case(value.text);
    for (const char* right : {"1/sr", "/sr", "sr-1", "sr^-1", "per sr"})
        if (unit == right)
            return;
    throw_input_error(reader.position(value),
                      fmt::format("the unit '{}' is not of a measurement", value.text),
                      "values are in 1/sr, where a white has 1/pi; scale them and leave the line "
                      "out");
}

/// Values of the '#' lines that a measurement may not contradict.
void check_header_line(const TextReader& reader, std::string_view line, BispectralData& data) {
    const std::optional<HeaderEntry> entry = header_entry(reader, line);
    if (!entry)
        return;
    const auto require = [&](std::string_view key, std::string_view right) {
        if (entry->name == key && lower_case(entry->value.text) != right)
            throw_input_error(reader.position(entry->value),
                              fmt::format("{} '{}' contradicts the headings of `measure`", key,
                                          entry->value.text),
                              fmt::format("its rows are {}", right));
    };
    require("quantity", "per-band");
    require("orientation", "rows-emission");
    if (entry->name == "anti-stokes")
        data.anti_stokes_allowed = is_first_of(reader, entry->value, "allowed", "refused");
    if (entry->name == "unit" || entry->name == "units")
        refuse_other_unit(reader, entry->value);
    refuse_factor(reader, *entry);
}

/// Cells with commas between them: a spreadsheet may have quoted them or taken semicolons.
std::string joined(const std::vector<TextToken>& cells) {
    std::string line;
    for (const TextToken& cell : cells)
        line.append(line.empty() ? "" : ",").append(cell.text);
    return line;
}

double angle(const TextReader& reader, const TextToken& token, double below) {
    if (token.text.empty())
        throw_input_error(reader.position(token), "a row without directions",
                          "hemispherical rows cannot be fitted; measure directions");
    const double degrees = reader.number(token);
    if (!(degrees >= 0.0 && degrees < below))
        throw_input_error(reader.position(token), fmt::format("{} degrees", degrees),
                          fmt::format("write 0 up to {}", below));
    return degrees;
}

/// True for a row of light that a slab scattered, which a fit leaves out as it does the mirror's.
/// Light of dyes in slabs, which comes out at another wavelength, is refused.
bool is_of_slab(const TextReader& reader, const std::vector<TextToken>& tokens) {
    if (tokens[7].text != "slab")
        return false;
    const bool is_shifted = reader.wavelength_nm(tokens[3]) != reader.wavelength_nm(tokens[4]);
    if (is_shifted && !is_gap(tokens[5].text) && reader.number(tokens[5]) != 0.0)
        throw_input_error(reader.position(tokens[7]),
                          "the sample has dyes in its layers, and a fit takes all fluorescence for "
                          "the substrate's",
                          "measure a sample whose layers hold no fluorophores");
    return true;
}

void read_row(const TextReader& reader, std::vector<TextToken> tokens, MeasuredLight light,
              RowsByDirections& rows) {
    drop_padding(tokens, column_count);
    if (tokens.size() != column_count)
        throw_input_error(reader.position(tokens.back()),
                          fmt::format("{} values in this line", tokens.size()),
                          fmt::format("write {}", headings));
    const bool takes_all = light == MeasuredLight::OfAll;
    const bool is_slab = tokens[7].text == "slab";
    if (tokens[7].text == "specular" || (!takes_all && is_of_slab(reader, tokens)))
        return;
    if (tokens[7].text != "diffuse" && !is_slab)
        throw_input_error(reader.position(tokens[7]),
                          fmt::format("'{}' is not a part", tokens[7].text),
                          "write diffuse, slab or specular");
    const Directions at{angle(reader, tokens[0], 90.0),
                        angle(reader, tokens[1], takes_all ? 180.0 : 90.0),
                        angle(reader, tokens[2], 360.0)};
    const auto number = [&](const TextToken& token) {
        return is_gap(token.text) ? nan_value : reader.number(token);
    };
    const auto wavelength = [&](const TextToken& token) {
        return PlacedWavelength{reader.wavelength_nm(token), reader.position(token),
                                half_last_digit(token.text)};
    };
    const double sigma = number(tokens[6]);
    rows[at].push_back({wavelength(tokens[4]), wavelength(tokens[3]),
                        std::numbers::pi * number(tokens[5]),
                        sigma > 0.0 ? std::numbers::pi * sigma : nan_value, is_slab});
}

/// The wavelengths that occur, each with its first place.
WavelengthGrid grid_of(const RowsByDirections& rows, PlacedWavelength Row::*wavelength,
                       const char* name) {
    std::map<double, PlacedWavelength> seen;
    for (const auto& [at, list] : rows)
        for (const Row& row : list)
            seen.emplace((row.*wavelength).nm, row.*wavelength);
    std::vector<PlacedWavelength> axis;
    for (const auto& [nm, placed] : seen)
        axis.push_back(placed);
    return axis_grid(axis, name, 1.0);
}

BispectralBlock block_of(const Directions& at, const std::vector<Row>& rows,
                         const BispectralData& data) {
    BispectralBlock block;
    block.geometry = {std::get<0>(at), std::get<1>(at), std::get<2>(at)};
    block.value = Eigen::MatrixXd::Constant(data.emission.count, data.excitation.count, nan_value);
    block.sigma = block.value;
    Eigen::MatrixXi seen[2]; // of the substrate, of slabs
    seen[0] = seen[1] = Eigen::MatrixXi::Zero(block.value.rows(), block.value.cols());
    for (const Row& row : rows) {
        const int o = data.emission.band_of(row.emission.nm);
        const int i = data.excitation.band_of(row.excitation.nm);
        if (seen[row.is_of_slab ? 1 : 0](o, i)++ > 0)
            throw_input_error(row.excitation.position,
                              fmt::format("excitation {} nm, emission {} nm is given twice",
                                          row.excitation.nm, row.emission.nm),
                              "keep one of the two lines");
        const bool is_second = seen[0](o, i) + seen[1](o, i) > 1;
        block.value(o, i) = row.value + (is_second ? block.value(o, i) : 0.0);
        block.sigma(o, i) = is_second ? std::hypot(row.sigma, block.sigma(o, i)) : row.sigma;
    }
    return block;
}

} // namespace

BispectralData read_measurement_blocks(const std::filesystem::path& file, MeasuredLight light) {
    TextReader reader(file);
    BispectralData data;
    RowsByDirections rows;
    bool past_headings = false;
    for (std::string_view line; reader.next_line(line);) {
        std::vector<TextToken> cells = reader.split_cells(line);
        drop_padding(cells, 1);
        if (is_remark(line))
            check_header_line(reader, line, data);
        else if (!is_line_of_cells(line))
            continue;
        else if (past_headings)
            read_row(reader, std::move(cells), light, rows);
        else if (joined(cells) == headings)
            past_headings = true;
        else
            throw_input_error(reader.position(reader.line_number(), 1),
                              "these headings are not known", fmt::format("write {}", headings));
    }
    if (rows.empty())
        throw_input_error(reader.end_position(), "no diffuse rows to fit",
                          "measure directions off the mirror");
    data.emission = grid_of(rows, &Row::emission, "emission");
    data.excitation = grid_of(rows, &Row::excitation, "excitation");
    for (const auto& [at, list] : rows)
        data.blocks.push_back(block_of(at, list, data));
    return data;
}

} // namespace reradiant
