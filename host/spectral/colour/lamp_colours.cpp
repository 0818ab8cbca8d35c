#include "host/spectral/colour/lamp_colours.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace reradiant {

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

MatrixColour colour_from(const Sums& sums) {
    if (!(sums.white[1] > 0.0))
        throw std::invalid_argument("the emission bands see none of the visible light");
    const double scale = 100.0 / sums.white[1];
    MatrixColour colour;
    add(colour.xyz, sums.reflected, scale);
    add(colour.xyz, sums.luminescent, scale);
    add(colour.white, sums.white, scale);
    colour.luminance_reflected = scale * sums.reflected[1];
    const double total = colour.xyz[0] + colour.xyz[1] + colour.xyz[2];
    colour.xy = total > 0.0 ? std::array{colour.xyz[0] / total, colour.xyz[1] / total}
                            : std::array{nan_value, nan_value};
    colour.lab = xyz_to_lab(colour.xyz, colour.white);
    return colour;
}

std::string reason_for_nanometres(const LampError& error, bool has_lines) {
    if (error.share > most_misjudged)
        return fmt::format("summed over 1 nm: plain sums at the bands would misjudge the {} by "
                           "{:.3g} %",
                           error.of, 100.0 * error.share);
    return has_lines ? "summed over 1 nm: the lamp has lines" : "";
}

} // namespace

LampColours::LampColours(Spectrum illuminant, ColourSum sum, ColourConditions conditions)
    : illuminant_(std::move(illuminant)), sum_(sum), conditions_(std::move(conditions)) {}

LampColours::OnGrids& LampColours::on_grids(const ReradiationMatrix& matrix) {
    const auto found = std::find_if(grids_.begin(), grids_.end(), [&](const OnGrids& one) {
        return one.emission == matrix.emission && one.excitation == matrix.excitation;
    });
    if (found != grids_.end())
        return *found;
    return grids_.emplace_back(OnGrids{matrix.emission, matrix.excitation, {}, {}});
}

const BandSums& LampColours::sums(OnGrids& grids, SumRange range) const {
    std::optional<BandSums>& made = grids.sums[static_cast<std::size_t>(range)];
    if (!made)
        made.emplace(grids.emission, grids.excitation, Viewing(illuminant_, conditions_), range);
    return *made;
}

const std::vector<double>& LampColours::light(OnGrids& grids, bool at_nanometres) const {
    std::optional<std::vector<double>>& made = grids.light[at_nanometres ? 1 : 0];
    if (!made)
        made = lights_of(grids.emission, illuminant_, at_nanometres);
    return *made;
}

/// The factors are undefined (NaN) where the light has less than 1e-9 of its largest value: no
/// instrument would see it, and the tail of a Gaussian lamp would give factors of 1e300.
void LampColours::fill_radiance_factors(MatrixColour& colour, const Exitance& exitance,
                                        OnGrids& grids) const {
    const std::vector<double>& lights = light(grids, colour.at_nanometres);
    const double dark =
        lights.empty() ? 0.0 : 1e-9 * *std::max_element(lights.begin(), lights.end());
    for (std::size_t o = 0; o < colour.nm.size(); ++o) {
        const auto row = static_cast<Eigen::Index>(o);
        colour.reflected.push_back(exitance.reflectance[row]);
        colour.luminescent.push_back(lights[o] > dark ? exitance.luminescent[row] / lights[o]
                                                      : nan_value);
        colour.total.push_back(colour.reflected.back() + colour.luminescent.back());
    }
}

LampError LampColours::plain_sums_misjudge(const ReradiationMatrix& matrix) {
    OnGrids& grids = on_grids(matrix);
    const BandSums &plain = sums(grids, SumRange::Bands),
                   &fine = sums(grids, SumRange::WithinBands);
    const Sums at_bands = plain.sums_of(plain.exitance_of(matrix));
    const Sums at_nanometres = fine.sums_of(fine.exitance_of(matrix));
    LampError error;
    const auto take = [&error](double off, double whole, const std::string& of) {
        if (whole > 0.0 && std::abs(off) / whole > error.share)
            error = {std::abs(off) / whole, of};
    };
    constexpr std::array names = {"lamp's own white (X)", "lamp's own white (Y)",
                                  "lamp's own white (Z)"};
    for (std::size_t c = 0; c < 3; ++c)
        take(at_bands.white[c] - at_nanometres.white[c], at_nanometres.white[c], names[c]);
    take(at_bands.luminescent[1] - at_nanometres.luminescent[1],
         at_nanometres.reflected[1] + at_nanometres.luminescent[1], "fluorescence");
    return error;
}

MatrixColour LampColours::colour_of(const ReradiationMatrix& matrix,
                                    std::optional<bool> at_nanometres) {
    const bool is_automatic = sum_ == ColourSum::Automatic && !at_nanometres;
    const LampError error = is_automatic ? plain_sums_misjudge(matrix) : LampError{};
    const bool has_lines = is_automatic && !illuminant_.lines().empty();
    const bool is_fine = at_nanometres.value_or(sum_ == ColourSum::E308 || has_lines ||
                                                error.share > most_misjudged);
    OnGrids& grids = on_grids(matrix);
    const BandSums& summed = sums(grids, sum_range(matrix.emission, sum_, is_fine));
    const Exitance exitance = summed.exitance_of(matrix);
    MatrixColour colour = colour_from(summed.sums_of(exitance));
    colour.nm = matrix.emission.centres_nm();
    colour.at_nanometres = is_fine;
    colour.reason = reason_for_nanometres(error, has_lines);
    fill_radiance_factors(colour, exitance, grids);
    return colour;
}

} // namespace reradiant
