#include "reradiant/reradiation.h"

#include "host/spectral/evidence/matrix_warnings.h"
#include "host/spectral/evidence/scatter_warnings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr double same_wavelength_in_steps = 1e-6;
constexpr double negative_rounding = 1e-6; // a model's entry below minus this is an error
constexpr double balance_slack = 1e-6;

void require_shape(const ReradiationMatrix& matrix) {
    if (matrix.values.rows() != matrix.emission.count ||
        matrix.values.cols() != matrix.excitation.count)
        throw std::invalid_argument(
            fmt::format("the matrix has {} x {} values for {} emission and {} excitation bands",
                        matrix.values.rows(), matrix.values.cols(), matrix.emission.count,
                        matrix.excitation.count));
}

bool is_anti_stokes(const ReradiationMatrix& matrix, int o, int i) {
    return matrix.emission.centre_nm(o) < matrix.excitation.centre_nm(i) &&
           diagonal_row(matrix, i) != o;
}

std::string entry_name(const ReradiationMatrix& matrix, int o, int i) {
    return fmt::format("excitation {} nm, emission {} nm", matrix.excitation.centre_nm(i),
                       matrix.emission.centre_nm(o));
}

void require_finite(const ReradiationMatrix& matrix) {
    for (int i = 0; i < matrix.excitation.count; ++i)
        for (int o = 0; o < matrix.emission.count; ++o)
            if (!std::isfinite(matrix.values(o, i)))
                throw std::invalid_argument(
                    fmt::format("the value at {} is not finite", entry_name(matrix, o, i)));
}

/// Refuses what a model may not hold: clearly negative entries, and emission below excitation.
void refuse_impossible_entries(const ReradiationMatrix& matrix) {
    for (int i = 0; i < matrix.excitation.count; ++i) {
        for (int o = 0; o < matrix.emission.count; ++o) {
            const double value = matrix.values(o, i);
            if (value < -negative_rounding)
                throw std::invalid_argument(
                    fmt::format("the value {} at {} is negative", value, entry_name(matrix, o, i)));
            if (value > 0.0 && !matrix.anti_stokes_allowed && is_anti_stokes(matrix, o, i))
                throw std::invalid_argument(
                    fmt::format("the value {} at {} is anti-Stokes, which the matrix does not "
                                "declare ('# anti-stokes: allowed')",
                                value, entry_name(matrix, o, i)));
        }
    }
}

MatrixRepair zero_impossible_entries(ReradiationMatrix& matrix) {
    MatrixRepair repair;
    const double positive = matrix.values.cwiseMax(0.0).sum();
    for (int i = 0; i < matrix.excitation.count; ++i) {
        for (int o = 0; o < matrix.emission.count; ++o) {
            double& value = matrix.values(o, i);
            if (value == 0.0)
                continue;
            if (value < 0.0) {
                ++repair.negative_entries;
                repair.negative_energy -= value;
                value = 0.0;
            } else if (!matrix.anti_stokes_allowed && is_anti_stokes(matrix, o, i)) {
                ++repair.anti_stokes_entries;
                repair.anti_stokes_energy += value;
                value = 0.0;
            }
        }
    }
    if (positive > 0.0) {
        repair.negative_energy /= positive;
        repair.anti_stokes_energy /= positive;
    }
    return repair;
}

/// `cause`: what the matrix looks like when it is not taken at its word; may be empty.
void refuse_energy_gain(const ReradiationMatrix& matrix, const std::vector<double>& radiant,
                        const std::string& cause) {
    for (int i = 0; i < matrix.excitation.count; ++i) {
        const double sum = radiant[static_cast<std::size_t>(i)];
        if (sum > 1.0 + balance_slack)
            throw std::invalid_argument(
                fmt::format("the column of excitation {} nm returns {:.6g} times the energy it "
                            "receives; at most 1 is possible{}{}",
                            matrix.excitation.centre_nm(i), sum, cause.empty() ? "" : "; ", cause));
    }
}

/// Share of each source cell that lies in each target cell: (target, source), in nm.
Eigen::MatrixXd overlap_nm(const WavelengthGrid& target, const WavelengthGrid& source) {
    Eigen::MatrixXd overlap(target.count, source.count);
    for (int s = 0; s < source.count; ++s)
        for (int t = 0; t < target.count; ++t)
            overlap(t, s) =
                std::max(0.0, std::min(target.upper_edge_nm(t), source.upper_edge_nm(s)) -
                                  std::max(target.lower_edge_nm(t), source.lower_edge_nm(s)));
    return overlap;
}

} // namespace

int diagonal_row(const ReradiationMatrix& matrix, int excitation_band) {
    const double wavelength_nm = matrix.excitation.centre_nm(excitation_band);
    const double position = (wavelength_nm - matrix.emission.from_nm) / matrix.emission.step_nm;
    const double row = std::round(position);
    const double step_nm = std::min(matrix.emission.step_nm, matrix.excitation.step_nm);
    if (!(row >= 0.0 && row < matrix.emission.count) ||
        std::abs(position - row) * matrix.emission.step_nm > same_wavelength_in_steps * step_nm)
        return -1;
    return static_cast<int>(row);
}

Spectrum ReradiationMatrix::reflectance() const {
    std::vector<double> wavelengths_nm, diagonal;
    for (int i = 0; i < excitation.count; ++i) {
        if (const int o = diagonal_row(*this, i); o >= 0) {
            wavelengths_nm.push_back(excitation.centre_nm(i));
            diagonal.push_back(values(o, i));
        }
    }
    return wavelengths_nm.empty() ? Spectrum() : Spectrum::table(wavelengths_nm, diagonal);
}

Eigen::MatrixXd ReradiationMatrix::fluorescent_part() const {
    Eigen::MatrixXd part = values;
    for (int i = 0; i < excitation.count; ++i)
        if (const int o = diagonal_row(*this, i); o >= 0)
            part(o, i) = 0.0;
    return part;
}

bool ReradiationMatrix::is_fluorescent() const {
    return (fluorescent_part().array() != 0.0).any();
}

ColumnBalance column_balance(const ReradiationMatrix& matrix) {
    require_shape(matrix);
    const double steps = matrix.emission.step_nm / matrix.excitation.step_nm;
    ColumnBalance balance;
    for (int i = 0; i < matrix.excitation.count; ++i) {
        const int diagonal = diagonal_row(matrix, i);
        double radiant = 0.0, photons = 0.0;
        for (int o = 0; o < matrix.emission.count; ++o) {
            const double energy = matrix.values(o, i) * (o == diagonal ? 1.0 : steps);
            radiant += energy;
            photons += energy * (o == diagonal ? 1.0
                                               : matrix.emission.centre_nm(o) /
                                                     matrix.excitation.centre_nm(i));
        }
        balance.radiant.push_back(radiant);
        balance.photons.push_back(photons);
    }
    return balance;
}

std::string MatrixRepair::text() const {
    std::string result;
    if (negative_entries > 0)
        result = fmt::format("{} negative entries count as zero ({:.3g} % of the energy)",
                             negative_entries, 100.0 * negative_energy);
    if (anti_stokes_entries > 0)
        result += fmt::format("{}{} anti-Stokes entries count as zero ({:.3g} % of the energy)",
                              result.empty() ? "" : ", ", anti_stokes_entries,
                              100.0 * anti_stokes_energy);
    return result.empty() ? result : "in scenes " + result;
}

MatrixRepair repair_for_rendering(ReradiationMatrix& matrix, std::vector<std::string>& warnings) {
    require_shape(matrix);
    require_finite(matrix);
    if (matrix.kind == MatrixKind::Model)
        refuse_impossible_entries(matrix);
    const std::vector<std::string> misreadings = misreading_warnings(matrix);
    warnings.insert(warnings.end(), misreadings.begin(), misreadings.end());
    for (std::string& warning : scatter_warnings(matrix))
        warnings.push_back(std::move(warning));
    MatrixRepair repair = zero_impossible_entries(matrix);
    const ColumnBalance balance = column_balance(matrix);
    refuse_energy_gain(matrix, balance.radiant, misreadings.empty() ? "" : misreadings.front());
    if (const std::string warning = photon_warning(balance.photons, matrix.excitation);
        !warning.empty())
        warnings.push_back(warning);
    return repair;
}

Eigen::MatrixXd fluorescence_on_cells(const ReradiationMatrix& matrix,
                                      const WavelengthGrid& cells) {
    require_shape(matrix);
    // F * dmu is stored; dividing by dmu gives F, which the overlaps integrate exactly.
    const Eigen::MatrixXd into_emission = overlap_nm(cells, matrix.emission) / cells.step_nm;
    const Eigen::MatrixXd from_excitation =
        overlap_nm(cells, matrix.excitation) / matrix.excitation.step_nm;
    return into_emission * matrix.fluorescent_part() * from_excitation.transpose();
}

} // namespace reradiant
