#include "reradiant/bispectral_data.h"

#include "host/base/output_ending.h"
#include "host/fit/data/measurement_reader.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "host/spectral/evidence/plausible_matrix.h"
#include "host/spectral/text/csv_lines.h"
#include "host/spectral/text/text_reader.h"
#include "reradiant/measure.h"
#include "reradiant/reradiation.h"
#include "reradiant/spectral_files.h"

#include <Eigen/Core>
#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace reradiant {

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
bool is_table(const std::filesystem::path& file) {
    const std::string ending = lower_case_ending(file);
    return ending != ".bfc" && ending != ".exr";
}

/// True for the CSV of `measure`, by its line of headings.
bool is_measurement_csv(const std::filesystem::path& file) {
    TextReader reader(file);
    for (std::string_view line; reader.next_line(line);)
        if (is_line_of_cells(line))
            return reader.split_cells(line)[0].text == "theta_i_deg";
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

void refuse_impossible_units(const BispectralData& data) {
    require_plausible_bands(data.emission, data.excitation, data.file);
    for (const BispectralBlock& block : data.blocks)
        require_plausible_values(block.value, data.file);
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

BispectralData read_unjudged_data(const std::filesystem::path& file, const TableForm& form,
                                  MeasuredLight light) {
    const bool is_measurement = form == TableForm{} && is_table(file) && is_measurement_csv(file);
    BispectralData data = is_measurement
                              ? read_measurement_blocks(file, light)
                              : from_matrix(read_reradiation(file, Gaps::BecomeNan, form));
    data.file = file;
    return data;
}

BispectralData read_bispectral_data(const std::filesystem::path& file, const TableForm& form) {
    BispectralData data = read_unjudged_data(file, form, MeasuredLight::OfSubstrate);
    refuse_impossible_units(data);
    const BispectralBlock& first = data.blocks.front(); // all have the file's axes and quantity
    warn_of_matrix(file.string(), {data.emission, data.excitation, first.value,
                                   MatrixKind::Measured, data.anti_stokes_allowed});
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
