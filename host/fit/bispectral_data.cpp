#include "host/fit/bispectral_data.h"

#include "host/fit/measurement_reader.h"
#include "host/measure/measure.h"
#include "host/spectral/matrix_io.h"
#include "host/spectral/text_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace reradiant {

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
/// Instruments see from the ultraviolet to the near infrared; anything else is another unit.
constexpr double shortest_nm = 100.0, longest_nm = 3000.0;
/// Radiance factors of 2.4 have been measured, summed over excitation. One band of 10 is percent.
constexpr double largest_value = 10.0;

/// True for the CSV of `measure`, by its line of headings.
bool is_measurement_csv(const std::filesystem::path& file) {
    TextReader reader(file);
    for (std::string_view line; reader.next_line(line);) {
        const std::string_view text = trimmed(line);
        if (!text.empty() && !text.starts_with('#'))
            return text.starts_with("theta_i_deg");
    }
    return false;
}

BispectralData from_matrix(const ReradiationMatrix& matrix) {
    BispectralData data;
    data.emission = matrix.emission;
    data.excitation = matrix.excitation;
    data.anti_stokes_allowed = matrix.anti_stokes_allowed;
    data.geometry = matrix.geometry;
    BispectralBlock block;
    block.value = matrix.values;
    block.sigma = Eigen::MatrixXd::Constant(matrix.values.rows(), matrix.values.cols(), nan_value);
    data.blocks.push_back(std::move(block));
    return data;
}

/// Line and column of the first number of a text file that is beyond the limit.
SourcePosition place_of_large_value(const std::filesystem::path& file) {
    if (lower_case_ending(file) != ".csv")
        return {file.string()};
    TextReader reader(file);
    bool headings = true;
    for (std::string_view line; reader.next_line(line);) {
        if (trimmed(line).empty() || trimmed(line).starts_with('#') ||
            std::exchange(headings, false))
            continue;
        const std::vector<TextToken> tokens = reader.split_at_commas(line);
        // The long forms have their wavelengths or angles first, the wide one only the first.
        const std::size_t first = tokens.size() == 3 ? 2 : tokens.size() == 8 ? 5 : 1;
        for (std::size_t k = first; k < tokens.size(); ++k)
            if (is_number(tokens[k].text) && std::abs(reader.number(tokens[k])) > largest_value)
                return reader.position(tokens[k]);
    }
    return {file.string()};
}

void refuse_impossible_units(const BispectralData& data) {
    for (const WavelengthGrid* grid : {&data.emission, &data.excitation})
        if (grid->from_nm < shortest_nm || grid->to_nm() > longest_nm)
            throw_input_error({data.file.string(), 1, 1},
                              fmt::format("wavelengths from {} to {} cannot be in nm",
                                          grid->from_nm, grid->to_nm()),
                              fmt::format("give nm, {} to {}", shortest_nm, longest_nm));
    double largest = 0.0;
    for (const BispectralBlock& block : data.blocks)
        for (const double value : block.value.reshaped())
            if (std::isfinite(value))
                largest = std::max(largest, std::abs(value));
    if (largest > largest_value)
        throw_input_error(place_of_large_value(data.file),
                          fmt::format("a radiance factor of {:.6g} in one band cannot be", largest),
                          "values have unit 1; divide percent by 100");
    if (data.measured_count() == 0)
        throw_input_error({data.file.string(), 1, 1}, "no entry was measured",
                          "some entries must be numbers");
}

Measurement as_measurement(const BispectralData& data) {
    Measurement measurement;
    measurement.bands = data.emission;
    measurement.notes = {"kind: measured", "quantity: per-band", "orientation: rows-emission"};
    if (data.anti_stokes_allowed)
        measurement.notes.push_back("anti-stokes: allowed");
    for (const BispectralBlock& block : data.blocks)
        for (int i = 0; i < data.excitation.count; ++i)
            for (int o = 0; o < data.emission.count; ++o)
                if (std::isfinite(block.value(o, i)))
                    measurement.rows.push_back(
                        {block.geometry->theta_i_deg, block.geometry->theta_o_deg,
                         block.geometry->phi_deg, data.excitation.centre_nm(i),
                         data.emission.centre_nm(o), block.value(o, i) / std::numbers::pi,
                         block.sigma(o, i) / std::numbers::pi, MeasuredPart::Diffuse});
    return measurement;
}

} // namespace

Eigen::Index BispectralData::measured_count() const {
    Eigen::Index count = 0;
    for (const BispectralBlock& block : blocks)
        count += (block.value.array() == block.value.array()).count();
    return count;
}

BispectralData read_bispectral_data(const std::filesystem::path& file) {
    BispectralData data = lower_case_ending(file) == ".csv" && is_measurement_csv(file)
                              ? read_measurement_blocks(file)
                              : from_matrix(read_reradiation(file, Gaps::BecomeNan));
    data.file = file;
    refuse_impossible_units(data);
    return data;
}

void write_bispectral_data(const std::filesystem::path& file, const BispectralData& data) {
    const bool is_bare = data.blocks.size() == 1 && !data.blocks[0].geometry;
    if (is_bare) {
        write_reradiation_csv(file,
                              {data.emission, data.excitation, data.blocks[0].value,
                               MatrixKind::Measured, data.anti_stokes_allowed, data.geometry},
                              {});
        return;
    }
    for (const BispectralBlock& block : data.blocks)
        if (!block.geometry)
            throw std::invalid_argument("several blocks need a geometry each");
    write_measurement(file, as_measurement(data));
}

} // namespace reradiant
