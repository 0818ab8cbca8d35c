#include "reradiant/colour_of_matrix.h"

#include "host/spectral/colour/band_sums.h"
#include "host/spectral/evidence/scatter_warnings.h"

#include <fmt/core.h>

#include <algorithm>

namespace reradiant {

namespace {

/// A colour leaves out less without a word.
constexpr double least_unseen_white = 0.001;

/// The largest share of X, Y and Z of the lamp's white that lies beyond the emission bands.
double unseen_white(const WavelengthGrid& bands, const Spectrum& illuminant, Observer observer) {
    const double from_nm = bands.lower_edge_nm(0), to_nm = bands.upper_edge_nm(bands.count - 1);
    const LampAtNanometres lamp(illuminant);
    const Eye eye(observer);
    Xyz unseen{}, whole{};
    for (int nm = e308_from_nm; nm <= e308_to_nm; ++nm) {
        add(whole, eye(nm), lamp(nm));
        if (nm < from_nm || nm > to_nm)
            add(unseen, eye(nm), lamp(nm));
    }
    double share = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
        if (whole[c] > 0.0)
            share = std::max(share, unseen[c] / whole[c]);
    return share;
}

/// Returns a sentence where the excitation bands leave out the reflectance of emission bands; empty
/// where they do not.
std::string unknown_reflectance(const ReradiationMatrix& matrix) {
    const WavelengthGrid& bands = matrix.excitation;
    const double missing =
        std::max(bands.from_nm - matrix.emission.from_nm, matrix.emission.to_nm() - bands.to_nm());
    const double from_nm = std::max(bands.from_nm, matrix.emission.from_nm),
                 to_nm = std::min(bands.to_nm(), matrix.emission.to_nm());
    if (missing <= 0.5 * bands.step_nm)
        return {};
    if (from_nm > to_nm)
        return "no wavelength is both an emission and an excitation band: the reflectance is not "
               "known and counts as 0";
    return fmt::format("reflectance is known from {:.6g} to {:.6g} nm only and carried on from "
                       "there as constant",
                       from_nm, to_nm);
}

/// Returns a sentence where the lamp's table starts within the excitation bands; empty elsewhere.
std::string dark_excitation(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                            const std::string& name) {
    const WavelengthGrid& bands = matrix.excitation;
    const Eigen::MatrixXd fluorescence = matrix.fluorescent_part();
    int dark = 0;
    double dark_sum = 0.0;
    for (int i = 0; i < bands.count; ++i)
        if (bands.centre_nm(i) < illuminant.data_from_nm() && !fluorescence.col(i).isZero(0.0)) {
            ++dark;
            dark_sum += fluorescence.col(i).sum();
        }
    if (dark == 0)
        return {};
    return fmt::format(
        "the table of {} starts at {:.6g} nm: the fluorescence of {} excitation band{} from {:.6g} "
        "nm counts as dark ({:.3g} % of what equal light in all bands would excite)",
        name, illuminant.data_from_nm(), dark, dark == 1 ? "" : "s", bands.from_nm,
        100.0 * dark_sum / fluorescence.sum());
}

} // namespace

std::vector<std::string> colour_warnings(const ReradiationMatrix& matrix,
                                         const Spectrum& illuminant, const std::string& name,
                                         Observer observer, double dark_on_purpose_below_nm) {
    std::vector<std::string> warnings = scatter_warnings(matrix);
    if (const std::string dark = dark_excitation(matrix, illuminant, name);
        !dark.empty() && illuminant.data_from_nm() > dark_on_purpose_below_nm)
        warnings.push_back(dark);
    if (const std::string unknown = unknown_reflectance(matrix); !unknown.empty())
        warnings.push_back(unknown);
    const double unseen = unseen_white(matrix.emission, illuminant, observer);
    if (!reaches_far_enough(matrix.emission) && unseen > least_unseen_white)
        warnings.push_back(fmt::format(
            "the emission bands end at {:.6g} and {:.6g} nm: up to {:.3g} % of the white (X, Y or "
            "Z) of {} lies outside, where the sample's colour is not known",
            matrix.emission.from_nm, matrix.emission.to_nm(), 100.0 * unseen, name));
    return warnings;
}

} // namespace reradiant
