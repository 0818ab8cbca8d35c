#include "host/measure/measured_sample_reader.h"

#include "host/spectral/evidence/plausible_matrix.h"
#include "host/spectral/files/matrix_csv_header.h"
#include "host/spectral/files/matrix_formats.h"

#include <fmt/core.h>

#include <limits>

namespace reradiant {

namespace {

constexpr std::string_view headings =
    "theta_i_deg,theta_o_deg,phi_deg,lambda_i_nm,lambda_o_nm,value,stderr,part";
constexpr std::size_t column_count = 8;

/// Cells with commas between them: a spreadsheet may have quoted them or taken semicolons.
std::string joined(const std::vector<TextToken>& cells) {
    std::string line;
    for (const TextToken& cell : cells)
        line.append(line.empty() ? "" : ",").append(cell.text);
    return line;
}

double angle(const TextReader& reader, const TextToken& token, double low, double below) {
    const double degrees = reader.number(token);
    if (!(degrees >= low && degrees < below))
        throw_input_error(reader.position(token), fmt::format("{} degrees", degrees),
                          fmt::format("write {} up to {}", low, below));
    return degrees;
}

/// Angles above 90 lie beneath a sheet.
MeasuredDirections directions(const TextReader& reader, const std::vector<TextToken>& cells) {
    MeasuredDirections at;
    at.theta_i_deg = angle(reader, cells[0], 0.0, 180.0 + 1e-9);
    at.hemispherical = cells[1].text.empty() && cells[2].text.empty();
    if (at.hemispherical)
        return at;
    at.theta_o_deg = angle(reader, cells[1], 0.0, 180.0 + 1e-9);
    at.phi_deg = angle(reader, cells[2], -360.0, 360.0 + 1e-9);
    return at;
}

} // namespace

MeasuredPart MeasuredSample::Reader::part(const TextToken& token) const {
    for (int k = 0; k < measured_parts; ++k) {
        const auto part = static_cast<MeasuredPart>(k);
        if (token.text == part_name(part))
            return part;
    }
    throw_input_error(reader_.position(token), fmt::format("'{}' is not a part", token.text),
                      "write diffuse, slab or specular");
}

double MeasuredSample::Reader::wavelength(const TextToken& token, Axis& axis) const {
    const PlacedWavelength placed{reader_.wavelength_nm(token), reader_.position(token),
                                  half_last_digit(token.text)};
    axis.emplace(placed.nm, placed);
    return placed.nm;
}

void MeasuredSample::Reader::read_row(std::vector<TextToken> cells) {
    drop_padding(cells, column_count);
    if (cells.size() != column_count)
        throw_input_error(reader_.position(cells.back()),
                          fmt::format("{} values in this line", cells.size()),
                          fmt::format("write {}", headings));
    Row row{};
    row.excitation_nm = wavelength(cells[3], excitation_);
    row.emission_nm = wavelength(cells[4], emission_);
    row.value =
        is_gap(cells[5].text) ? std::numeric_limits<double>::quiet_NaN() : reader_.number(cells[5]);
    row.part = part(cells[7]);
    row.line = cells[0].line;
    sample_.rows_[directions(reader_, cells)].push_back(row);
}

void MeasuredSample::Reader::read_remark(std::string_view line) {
    const std::optional<HeaderEntry> entry = header_entry(reader_, line);
    if (!entry)
        return;
    const TextToken& value = entry->value;
    if (entry->name == "kind")
        sample_.is_measured_ = is_first_of(reader_, value, "measured", "model");
    else if (entry->name == "anti-stokes")
        sample_.anti_stokes_allowed_ = is_first_of(reader_, value, "allowed", "refused");
    else
        refuse_factor(reader_, *entry);
}

void MeasuredSample::Reader::read_rows() {
    bool past_headings = false;
    for (std::string_view line; reader_.next_line(line);) {
        if (is_remark(line))
            read_remark(line);
        if (!is_line_of_cells(line))
            continue;
        std::vector<TextToken> cells = reader_.split_cells(line);
        drop_padding(cells, 1);
        if (past_headings)
            read_row(std::move(cells));
        else if (joined(cells) == headings)
            past_headings = true;
        else
            throw_input_error(reader_.position(reader_.line_number(), 1),
                              "these headings are not known", fmt::format("write {}", headings));
    }
    if (sample_.rows_.empty())
        throw_input_error(reader_.end_position(), "no row of a measurement in this file",
                          fmt::format("write {}", headings));
}

WavelengthGrid MeasuredSample::Reader::grid(const Axis& axis, const char* name) const {
    std::vector<PlacedWavelength> placed;
    for (const auto& [nm, one] : axis)
        placed.push_back(one);
    return axis_grid(placed, name, 1.0);
}

void MeasuredSample::Reader::read() {
    sample_.file_ = reader_.name();
    read_rows();
    sample_.emission_ = grid(emission_, "emission");
    sample_.excitation_ = grid(excitation_, "excitation");
    require_plausible_bands(sample_.emission_, sample_.excitation_, sample_.file_);
    require_matrix_size(reader_.end_position(), static_cast<std::size_t>(sample_.emission_.count),
                        static_cast<std::size_t>(sample_.excitation_.count));
    place_rows();
}

void MeasuredSample::Reader::place_rows() {
    ReradiationMatrix axes;
    axes.emission = sample_.emission_;
    axes.excitation = sample_.excitation_;
    for (auto& [at, rows] : sample_.rows_)
        for (Row& row : rows) {
            row.emission = axes.emission.band_of(row.emission_nm);
            row.excitation = axes.excitation.band_of(row.excitation_nm);
            row.is_diagonal = diagonal_row(axes, row.excitation) == row.emission;
        }
}

} // namespace reradiant
