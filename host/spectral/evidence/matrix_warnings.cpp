#include "host/spectral/evidence/matrix_warnings.h"

#include "host/base/logging.h"
#include "host/spectral/evidence/matrix_evidence.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

constexpr double balance_slack = 1e-6;
/// Nine measured samples return 36 to 99 % of the energy of their best excitation band, a hundredth
/// of which is below this; black paints return some percent.
constexpr double darkest_sample = 0.01;

/// Measured samples have 0 to 8 % of their fluorescence on this side, by noise.
bool is_exchanged(const ReradiationMatrix& matrix, const MatrixEvidence& evidence) {
    return !matrix.anti_stokes_allowed && evidence.stands_out &&
           evidence.anti_stokes_share() > emission_share;
}

std::string strength_warning(const ReradiationMatrix& matrix, const MatrixEvidence& evidence) {
    const double step_nm = matrix.excitation.step_nm;
    const std::string finding = fmt::format(
        "the excitation band at {:.6g} nm has {:.3g} photons re-emitted for each that it receives",
        evidence.photons_nm, evidence.photons);
    if (evidence.photons > most_photons)
        return was_taken_as_density(evidence, step_nm)
                   ? finding +
                         ", which cannot be; if the values are per band and were taken as per "
                         "nm, declare '# quantity: per-band', else check their scale"
                   : finding + ", which cannot be; check the unit and the scale of the values";
    if (evidence.stands_out && evidence.photons < fewest_photons &&
        has_usual_photons(evidence.photons * step_nm))
        return fmt::format("at most {:.3g} photons are re-emitted for each that an excitation band "
                           "receives (at {:.6g} nm): a faint fluorescence, or values per nm that "
                           "were taken as per band; then declare '# quantity: density-per-nm'",
                           evidence.photons, evidence.photons_nm);
    return {};
}

std::string energy_warning(const std::vector<double>& radiant, const WavelengthGrid& excitation) {
    const auto worst = std::max_element(radiant.begin(), radiant.end());
    if (worst == radiant.end() || *worst <= 1.0 + balance_slack)
        return {};
    return fmt::format("the column of excitation {:.6g} nm returns {:.6g} times the energy it "
                       "receives; at most 1 is possible, and scenes refuse more",
                       excitation.centre_nm(static_cast<int>(worst - radiant.begin())), *worst);
}

} // namespace

std::vector<std::string> misreading_warnings(const ReradiationMatrix& matrix) {
    std::vector<std::string> warnings;
    MatrixEvidence evidence = evidence_of(matrix);
    ReradiationMatrix right;
    const bool exchange = is_exchanged(matrix, evidence);
    if (exchange) {
        warnings.push_back(fmt::format(
            "{:.0f} % of the fluorescence lies below its excitation (anti-Stokes): rows and "
            "columns are probably exchanged; declare the other '# orientation' (--rows)",
            100.0 * evidence.anti_stokes_share()));
        right = exchanged(matrix);
        evidence = evidence_of(right);
    }
    if (std::string warning = strength_warning(exchange ? right : matrix, evidence);
        !warning.empty())
        warnings.push_back(std::move(warning));
    if (evidence.largest_energy > 0.0 && evidence.largest_energy < darkest_sample)
        warnings.push_back(fmt::format(
            "no excitation band returns more than {:.2g} % of its energy: the deepest black, or "
            "values of unit 1 that were divided by 100 as percent",
            100.0 * evidence.largest_energy));
    return warnings;
}

std::string photon_warning(const std::vector<double>& photons, const WavelengthGrid& excitation) {
    const auto worst = std::max_element(photons.begin(), photons.end());
    if (worst == photons.end() || *worst <= 1.0 + balance_slack)
        return {};
    const auto over = std::count_if(photons.begin(), photons.end(),
                                    [](double sum) { return sum > 1.0 + balance_slack; });
    return fmt::format("{} excitation column{} return{} more photons than {} receive{}, the most "
                       "{:.6g} per photon at {:.6g} nm",
                       over, over == 1 ? "" : "s", over == 1 ? "s" : "", over == 1 ? "it" : "they",
                       over == 1 ? "s" : "", *worst,
                       excitation.centre_nm(static_cast<int>(worst - photons.begin())));
}

std::vector<std::string> matrix_warnings(const ReradiationMatrix& matrix) {
    ReradiationMatrix whole = matrix;
    whole.values = matrix.values.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
    std::vector<std::string> warnings = misreading_warnings(whole);
    if (!warnings.empty())
        return warnings;
    const ColumnBalance balance = column_balance(whole);
    for (const std::string& warning : {energy_warning(balance.radiant, matrix.excitation),
                                       photon_warning(balance.photons, matrix.excitation)})
        if (!warning.empty())
            warnings.push_back(warning);
    return warnings;
}

void warn_of_matrix(const std::string& name, const ReradiationMatrix& matrix) {
    for (const std::string& warning : matrix_warnings(matrix))
        logging::warn("{}{}{}", name, name.empty() ? "" : ": ", warning);
}

} // namespace reradiant
