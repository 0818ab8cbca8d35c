#include "host/spectral/colour_of_matrix.h"

#include "host/spectral/scatter_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
/// Range of the weights of ASTM E308.
constexpr int e308_from_nm = 360, e308_to_nm = 780;

/// Colour matching functions at a wavelength; zero outside 360-830 nm.
Xyz observer_at(double nm) {
    static const std::array<Spectrum, 3> curves = [] {
        const ColourMatching& table = cie_1931_2_degree();
        return std::array<Spectrum, 3>{Spectrum::table(table.wavelengths_nm, table.x),
                                       Spectrum::table(table.wavelengths_nm, table.y),
                                       Spectrum::table(table.wavelengths_nm, table.z)};
    }();
    const std::vector<double>& nodes = cie_1931_2_degree().wavelengths_nm;
    if (nm < nodes.front() || nm > nodes.back())
        return {};
    return {curves[0](nm), curves[1](nm), curves[2](nm)};
}

void add(Xyz& sum, const Xyz& term, double factor) {
    for (std::size_t c = 0; c < 3; ++c)
        sum[c] += factor * term[c];
}

/// Calls visit(band, share) with Lagrange's coefficients of the bands around a wavelength.
void interpolate(const WavelengthGrid& grid, double nm,
                 const std::function<void(int, double)>& visit) {
    const double position = (nm - grid.from_nm) / grid.step_nm;
    if (position <= 0.0 || position >= grid.count - 1) {
        visit(position <= 0.0 ? 0 : grid.count - 1, 1.0);
        return;
    }
    const int interval = static_cast<int>(position);
    const int first = std::max(0, interval - 1), last = std::min(grid.count - 1, interval + 2);
    for (int band = first; band <= last; ++band) {
        double share = 1.0;
        for (int other = first; other <= last; ++other)
            if (other != band)
                share *= (position - other) / (band - other);
        visit(band, share);
    }
}

/// The parts that a colour is summed from.
struct Exitance {
    Eigen::VectorXd reflectance, luminescent; ///< per emission band
};

/// Mean irradiance of every excitation band, as it counts in the sum.
Eigen::VectorXd irradiance_of(const WavelengthGrid& bands, const Spectrum& illuminant,
                              ColourSum sum) {
    Eigen::VectorXd irradiance = Eigen::VectorXd::Zero(bands.count);
    if (sum == ColourSum::Bands) {
        for (int i = 0; i < bands.count; ++i)
            irradiance[i] = illuminant(bands.centre_nm(i));
        return irradiance;
    }
    const double from = bands.lower_edge_nm(0), width = bands.count * bands.step_nm;
    const int pieces = std::max(bands.count, static_cast<int>(std::lround(width)));
    const double piece_nm = width / pieces;
    for (int piece = 0; piece < pieces; ++piece) {
        const double nm = from + (piece + 0.5) * piece_nm;
        interpolate(bands, nm, [&](int band, double share) {
            irradiance[band] += share * illuminant(nm) * piece_nm / bands.step_nm;
        });
    }
    return irradiance;
}

Exitance exitance_of(const ReradiationMatrix& matrix, const Spectrum& illuminant, ColourSum sum) {
    const Spectrum reflectance = matrix.reflectance();
    Exitance exitance;
    exitance.reflectance.resize(matrix.emission.count);
    for (int o = 0; o < matrix.emission.count; ++o)
        exitance.reflectance[o] = reflectance(matrix.emission.centre_nm(o));
    exitance.luminescent =
        matrix.fluorescent_part() * irradiance_of(matrix.excitation, illuminant, sum);
    return exitance;
}

/// XYZ of what is reflected, re-radiated, and reflected by the perfect diffuser, in one scale.
struct Sums {
    Xyz reflected{}, luminescent{}, white{};
};

Sums sum_over_bands(const WavelengthGrid& bands, const Exitance& exitance,
                    const Spectrum& illuminant) {
    Sums sums;
    for (int o = 0; o < bands.count; ++o) {
        const double nm = bands.centre_nm(o), light = illuminant(nm);
        const Xyz eye = observer_at(nm);
        add(sums.reflected, eye, exitance.reflectance[o] * light);
        add(sums.luminescent, eye, exitance.luminescent[o]);
        add(sums.white, eye, light);
    }
    return sums;
}

Sums sum_over_nanometres(const WavelengthGrid& bands, const Exitance& exitance,
                         const Spectrum& illuminant) {
    Sums sums;
    for (int nm = e308_from_nm; nm <= e308_to_nm; ++nm) {
        const double light = illuminant(nm);
        const Xyz eye = observer_at(nm);
        interpolate(bands, nm, [&](int o, double share) {
            add(sums.reflected, eye, share * exitance.reflectance[o] * light);
            add(sums.luminescent, eye, share * exitance.luminescent[o]);
        });
        add(sums.white, eye, light);
    }
    return sums;
}

/// Undefined (NaN) where the light has less than 1e-9 of its largest value: no instrument would see
/// it, and the tail of a Gaussian lamp would give factors of 1e300.
void fill_radiance_factors(MatrixColour& colour, const Exitance& exitance,
                           const Spectrum& illuminant) {
    const std::vector<double> lights = illuminant.at(colour.nm);
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

} // namespace

MatrixColour colour_of_matrix(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                              ColourSum sum) {
    const Exitance exitance = exitance_of(matrix, illuminant, sum);
    const Sums sums = sum == ColourSum::Bands
                          ? sum_over_bands(matrix.emission, exitance, illuminant)
                          : sum_over_nanometres(matrix.emission, exitance, illuminant);
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
    colour.nm = matrix.emission.centres_nm();
    fill_radiance_factors(colour, exitance, illuminant);
    return colour;
}

std::vector<std::string> colour_warnings(const ReradiationMatrix& matrix,
                                         const Spectrum& illuminant, const std::string& name) {
    std::vector<std::string> warnings = scatter_warnings(matrix);
    const WavelengthGrid& bands = matrix.excitation;
    const Eigen::MatrixXd fluorescence = matrix.fluorescent_part();
    int dark = 0;
    for (int i = 0; i < bands.count; ++i)
        if (bands.centre_nm(i) < illuminant.data_from_nm() && !fluorescence.col(i).isZero(0.0))
            ++dark;
    if (dark > 0)
        warnings.push_back(fmt::format(
            "the table of {} starts at {:.6g} nm: the fluorescence of {} excitation "
            "band{} from {:.6g} nm counts as dark",
            name, illuminant.data_from_nm(), dark, dark == 1 ? "" : "s", bands.from_nm));
    const double missing =
        std::max(bands.from_nm - matrix.emission.from_nm, matrix.emission.to_nm() - bands.to_nm());
    if (missing > 0.5 * bands.step_nm)
        warnings.push_back(fmt::format("reflectance is known from {:.6g} to {:.6g} nm only and "
                                       "carried on from there as constant",
                                       std::max(bands.from_nm, matrix.emission.from_nm),
                                       std::min(bands.to_nm(), matrix.emission.to_nm())));
    return warnings;
}

Whiteness cie_whiteness(const Xyz& xyz, const Xyz& white) {
    const auto chromaticity = [](const Xyz& v) {
        const double sum = v[0] + v[1] + v[2];
        return std::array{v[0] / sum, v[1] / sum};
    };
    const std::array<double, 2> colour = chromaticity(xyz), neutral = chromaticity(white);
    const double x = neutral[0] - colour[0], y = neutral[1] - colour[1];
    Whiteness result;
    result.whiteness = xyz[1] + 800.0 * x + 1700.0 * y;
    result.tint = 1000.0 * x - 650.0 * y;
    result.within_limits = result.whiteness > 40.0 && result.whiteness < 5.0 * xyz[1] - 280.0 &&
                           result.tint > -4.0 && result.tint < 2.0;
    return result;
}

} // namespace reradiant
