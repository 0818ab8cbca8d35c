#include "reradiant/colour_of_matrix.h"

#include "host/spectral/colour/band_sums.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
/// Fills in the radiance factors. They are undefined (NaN) where the light has less than 1e-9 of
/// its largest value: no instrument would see it, and the tail of a Gaussian lamp would give
/// factors of 1e300.
void fill_radiance_factors(MatrixColour& colour, const WavelengthGrid& bands,
                           const Exitance& exitance, const Spectrum& illuminant) {
    std::vector<double> lights = illuminant.at(colour.nm);
    if (colour.at_nanometres)
        for (int o = 0; o < bands.count; ++o)
            lights[static_cast<std::size_t>(o)] =
                illuminant.average(bands.lower_edge_nm(o), bands.upper_edge_nm(o));
    const double dark =
        lights.empty() ? 0.0 : 1e-9 * *std::max_element(lights.begin(), lights.end());
    for (std::size_t o = 0; o < colour.nm.size(); ++o) {
        const auto row = static_cast<Eigen::Index>(o);
        const double light = lights[o];
        colour.reflected.push_back(exitance.reflectance[row]);
        colour.luminescent.push_back(light > dark ? exitance.luminescent[row] / light : nan_value);
        colour.total.push_back(colour.reflected.back() + colour.luminescent.back());
    }
}

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

} // namespace

LampError plain_sums_misjudge(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                              const ColourConditions& conditions) {
    const WavelengthGrid& bands = matrix.emission;
    const Viewing viewing(illuminant, conditions);
    const Exitance plain = exitance_of(matrix, viewing, false);
    const Exitance fine = exitance_of(matrix, viewing, true);
    const Sums at_bands = sum_over_bands(bands, plain, viewing);
    const Sums at_nanometres = sum_within_bands(bands, fine, viewing);
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

MatrixColour colour_of_matrix(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                              ColourSum sum, const ColourConditions& conditions) {
    const LampError error = sum == ColourSum::Automatic
                                ? plain_sums_misjudge(matrix, illuminant, conditions)
                                : LampError{};
    const bool has_lines = sum == ColourSum::Automatic && !illuminant.lines().empty();
    const bool at_nanometres = sum == ColourSum::E308 || has_lines || error.share > most_misjudged;
    const WavelengthGrid& bands = matrix.emission;
    const Viewing viewing(illuminant, conditions);
    const Exitance exitance = exitance_of(matrix, viewing, at_nanometres);
    Sums sums;
    if (!at_nanometres)
        sums = sum_over_bands(bands, exitance, viewing);
    else if (sum == ColourSum::E308 || reaches_far_enough(bands))
        sums = sum_as_e308(bands, exitance, viewing);
    else
        sums = sum_within_bands(bands, exitance, viewing);
    MatrixColour colour = colour_from(sums);
    colour.nm = bands.centres_nm();
    colour.at_nanometres = at_nanometres;
    if (error.share > most_misjudged)
        colour.reason = fmt::format("summed over 1 nm: plain sums at the bands would misjudge the "
                                    "{} by {:.3g} %",
                                    error.of, 100.0 * error.share);
    else if (has_lines)
        colour.reason = "summed over 1 nm: the lamp has lines";
    fill_radiance_factors(colour, bands, exitance, illuminant);
    return colour;
}

} // namespace reradiant
