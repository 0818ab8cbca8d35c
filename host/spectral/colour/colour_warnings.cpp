#include "reradiant/colour_of_matrix.h"

#include "host/spectral/colour/band_sums.h"
#include "host/spectral/colour/lamp.h"
#include "host/spectral/evidence/scatter_warnings.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace reradiant {

namespace {

/// A colour leaves out less without a word.
constexpr double least_unseen_white = 0.001;
/// A lamp is hardly seen where its luminance, over that of the same power at the eye's best
/// wavelength, is less: so are lines below 408 nm and beyond 720 nm. Illuminants have 0.1 to 0.5.
constexpr double least_seen_white = 0.001;
constexpr int power_from_nm = 300, power_to_nm = 830;

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

/// Appends a sentence for the fluorescence of the excitation bands beyond one end of the lamp's
/// table, where there are such.
template <typename IsBeyond>
void add_dark_excitation(std::vector<std::string>& warnings, const ReradiationMatrix& matrix,
                         const std::string& table_end, const std::string& other_end,
                         const IsBeyond& is_beyond) {
    const Eigen::MatrixXd fluorescence = matrix.fluorescent_part();
    const WavelengthGrid& bands = matrix.excitation;
    int dark = 0;
    double sum = 0.0;
    for (int i = 0; i < bands.count; ++i)
        if (is_beyond(bands.centre_nm(i)) && !fluorescence.col(i).isZero(0.0)) {
            ++dark;
            sum += fluorescence.col(i).sum();
        }
    if (dark > 0)
        warnings.push_back(fmt::format(
            "{}: the fluorescence of {} excitation band{} {} nm counts as dark ({:.3g} % of what "
            "equal light in all bands would excite)",
            table_end, dark, dark == 1 ? "" : "s", other_end, 100.0 * sum / fluorescence.sum()));
}

/// Appends sentences where the lamp's table starts or ends within the excitation bands.
void add_dark_ends(std::vector<std::string>& warnings, const ReradiationMatrix& matrix,
                   const Spectrum& illuminant, const std::string& name,
                   double dark_on_purpose_below_nm) {
    const double from_nm = illuminant.data_from_nm(), to_nm = illuminant.data_to_nm();
    const WavelengthGrid& bands = matrix.excitation;
    if (bands.from_nm < from_nm && from_nm > dark_on_purpose_below_nm)
        add_dark_excitation(
            warnings, matrix, fmt::format("the table of {} starts at {:.6g} nm", name, from_nm),
            fmt::format("from {:.6g}", bands.from_nm), [&](double nm) { return nm < from_nm; });
    if (bands.to_nm() > to_nm)
        add_dark_excitation(
            warnings, matrix, fmt::format("the table of {} ends at {:.6g} nm", name, to_nm),
            fmt::format("up to {:.6g}", bands.to_nm()), [&](double nm) { return nm > to_nm; });
}

} // namespace

std::vector<std::string> colour_warnings(const ReradiationMatrix& matrix,
                                         const Spectrum& illuminant, const std::string& name,
                                         Observer observer, double dark_on_purpose_below_nm) {
    std::vector<std::string> warnings = scatter_warnings(matrix);
    for (std::string& warning : lamp_warnings(
             matrix, {.name = name, .light = illuminant, .cut_below_nm = dark_on_purpose_below_nm},
             observer))
        warnings.push_back(std::move(warning));
    return warnings;
}

std::vector<std::string> lamp_warnings(const ReradiationMatrix& matrix, const Lamp& lamp,
                                       Observer observer) {
    const Spectrum& illuminant = lamp.light;
    const std::string& name = lamp.name;
    std::vector<std::string> warnings;
    add_dark_ends(warnings, matrix, illuminant, name, lamp.cut_below_nm);
    if (const std::string unknown = unknown_reflectance(matrix); !unknown.empty())
        warnings.push_back(unknown);
    if (reaches_far_enough(matrix.emission))
        return warnings;
    const double unseen = unseen_white(matrix.emission, illuminant, observer);
    if (unseen > least_unseen_white)
        warnings.push_back(fmt::format(
            "the emission bands end at {:.6g} and {:.6g} nm: up to {:.3g} % of the white (X, Y or "
            "Z) of {} lies outside, where the sample's colour is not known",
            matrix.emission.from_nm, matrix.emission.to_nm(), 100.0 * unseen, name));
    return warnings;
}

std::string faint_white_warning(const Lamp& lamp, Observer observer) {
    const Spectrum& light = lamp.weighted_by ? *lamp.weighted_by : lamp.light;
    const LampAtNanometres at(light);
    const Eye eye(observer);
    double seen = 0.0, power = 0.0;
    for (int nm = power_from_nm; nm <= power_to_nm; ++nm) {
        seen += eye(nm)[1] * at(nm);
        power += at(nm);
    }
    if (!(power > 0.0) || seen >= least_seen_white * power)
        return {};
    return fmt::format(
        "the eye sees almost nothing of {} (its light counts by {:.2g} of that of the eye's best "
        "wavelength): a white is all but dark, and XYZ, Lab and factors relative to it are huge "
        "where the sample fluoresces; add the light that the sample is seen in, as in D65+30*{}",
        lamp.name, seen / power, lamp.name.find('+') == std::string::npos ? lamp.name : "L:365");
}

} // namespace reradiant
