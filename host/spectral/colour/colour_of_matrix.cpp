#include "reradiant/colour_of_matrix.h"

#include "host/spectral/evidence/scatter_warnings.h"

#include <fmt/core.h>

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
/// A colour leaves out less without a word.
constexpr double least_unseen_white = 0.001;

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

/// A lamp's light around a wavelength, per nm. Tables in steps of 1 nm or more count with their
/// value there, as the standards have it. What is finer counts with its mean over the nanometre.
class LampAtNanometres {
public:
    explicit LampAtNanometres(const Spectrum& lamp)
        : lamp_(lamp), smooth_(lamp.without_lines()), is_fine_(is_finer_than_1_nm(smooth_)) {}

    double operator()(double nm) const {
        if (is_fine_)
            return lamp_.average(nm - 0.5, nm + 0.5);
        double light = smooth_(nm);
        for (const SpectralLine& line : lamp_.lines())
            light += Spectrum::line(line.centre_nm, line.width_nm, line.integral)
                         .average(nm - 0.5, nm + 0.5);
        return light;
    }

private:
    /// Nodes that lie closer than 1e-4 nm are the two sides of a step.
    static bool is_finer_than_1_nm(const Spectrum& smooth) {
        constexpr double step_nm = 1e-4, rounding_nm = 1e-3;
        const std::vector<double> nodes = smooth.breakpoints_nm();
        for (std::size_t k = 1; k < nodes.size(); ++k)
            if (nodes[k] - nodes[k - 1] > step_nm && nodes[k] - nodes[k - 1] < 1.0 - rounding_nm)
                return true;
        return false;
    }

    const Spectrum& lamp_;
    Spectrum smooth_;
    bool is_fine_;
};

/// The parts that a colour is summed from.
struct Exitance {
    Eigen::VectorXd reflectance, luminescent; ///< per emission band
};

/// Mean irradiance of every excitation band, as it counts in the sum.
Eigen::VectorXd irradiance_of(const WavelengthGrid& bands, const Spectrum& illuminant,
                              bool at_nanometres) {
    Eigen::VectorXd irradiance = Eigen::VectorXd::Zero(bands.count);
    if (!at_nanometres) {
        for (int i = 0; i < bands.count; ++i)
            irradiance[i] = illuminant(bands.centre_nm(i));
        return irradiance;
    }
    const double from = bands.lower_edge_nm(0), width = bands.count * bands.step_nm;
    const int pieces = std::max(bands.count, static_cast<int>(std::lround(width)));
    const double piece_nm = width / pieces;
    const LampAtNanometres lamp(illuminant);
    for (int piece = 0; piece < pieces; ++piece) {
        const double nm = from + (piece + 0.5) * piece_nm;
        const double light = lamp(nm) * piece_nm / bands.step_nm;
        interpolate(bands, nm, [&](int band, double share) { irradiance[band] += share * light; });
    }
    return irradiance;
}

Exitance exitance_of(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                     bool at_nanometres) {
    const Spectrum reflectance = matrix.reflectance();
    Exitance exitance;
    exitance.reflectance.resize(matrix.emission.count);
    for (int o = 0; o < matrix.emission.count; ++o)
        exitance.reflectance[o] = reflectance(matrix.emission.centre_nm(o));
    exitance.luminescent =
        matrix.fluorescent_part() * irradiance_of(matrix.excitation, illuminant, at_nanometres);
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
        add(sums.reflected, eye, bands.step_nm * exitance.reflectance[o] * light);
        add(sums.luminescent, eye, bands.step_nm * exitance.luminescent[o]);
        add(sums.white, eye, bands.step_nm * light);
    }
    return sums;
}

/// Sums over whole nanometres, those at the very ends by half.
Sums sum_over_nanometres(const WavelengthGrid& bands, const Exitance& exitance,
                         const Spectrum& illuminant, double from_nm, double to_nm) {
    const LampAtNanometres lamp(illuminant);
    Sums sums;
    for (double nm = std::ceil(from_nm); nm <= to_nm; nm += 1.0) {
        const double weight = nm == from_nm || nm == to_nm ? 0.5 : 1.0;
        const double light = weight * lamp(nm);
        const Xyz eye = observer_at(nm);
        interpolate(bands, nm, [&](int o, double share) {
            add(sums.reflected, eye, share * exitance.reflectance[o] * light);
            add(sums.luminescent, eye, weight * share * exitance.luminescent[o]);
        });
        add(sums.white, eye, light);
    }
    return sums;
}

/// The standard's ends count in full.
constexpr double whole_end_nm = 0.25;

Sums sum_as_e308(const WavelengthGrid& bands, const Exitance& exitance,
                 const Spectrum& illuminant) {
    return sum_over_nanometres(bands, exitance, illuminant, e308_from_nm - whole_end_nm,
                               e308_to_nm + whole_end_nm);
}

Sums sum_within_bands(const WavelengthGrid& bands, const Exitance& exitance,
                      const Spectrum& illuminant) {
    return sum_over_nanometres(bands, exitance, illuminant, bands.lower_edge_nm(0),
                               bands.upper_edge_nm(bands.count - 1));
}

/// The standard carries the last values on, which it allows from 400 and to 700 nm.
bool reaches_far_enough(const WavelengthGrid& bands) {
    return bands.from_nm < 400.5 && bands.to_nm() > 699.5;
}

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

/// The largest share of X, Y and Z of the lamp's white that lies beyond the emission bands.
double unseen_white(const WavelengthGrid& bands, const Spectrum& illuminant) {
    const double from_nm = bands.lower_edge_nm(0), to_nm = bands.upper_edge_nm(bands.count - 1);
    const LampAtNanometres lamp(illuminant);
    Xyz unseen{}, whole{};
    for (int nm = e308_from_nm; nm <= e308_to_nm; ++nm) {
        const Xyz eye = observer_at(nm);
        add(whole, eye, lamp(nm));
        if (nm < from_nm || nm > to_nm)
            add(unseen, eye, lamp(nm));
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

} // namespace

LampError plain_sums_misjudge(const ReradiationMatrix& matrix, const Spectrum& illuminant) {
    const WavelengthGrid& bands = matrix.emission;
    const Exitance plain = exitance_of(matrix, illuminant, false);
    const Exitance fine = exitance_of(matrix, illuminant, true);
    const Sums at_bands = sum_over_bands(bands, plain, illuminant);
    const Sums at_nanometres = sum_within_bands(bands, fine, illuminant);
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
                              ColourSum sum) {
    const LampError error =
        sum == ColourSum::Automatic ? plain_sums_misjudge(matrix, illuminant) : LampError{};
    const bool chosen = error.share > most_misjudged;
    const bool at_nanometres = sum == ColourSum::E308 || chosen;
    const WavelengthGrid& bands = matrix.emission;
    const Exitance exitance = exitance_of(matrix, illuminant, at_nanometres);
    Sums sums;
    if (!at_nanometres)
        sums = sum_over_bands(bands, exitance, illuminant);
    else if (sum == ColourSum::E308 || reaches_far_enough(bands))
        sums = sum_as_e308(bands, exitance, illuminant);
    else
        sums = sum_within_bands(bands, exitance, illuminant);
    MatrixColour colour = colour_from(sums);
    colour.nm = bands.centres_nm();
    colour.at_nanometres = at_nanometres;
    if (chosen)
        colour.reason = fmt::format("summed over 1 nm: plain sums at the bands would misjudge the "
                                    "{} by {:.3g} %",
                                    error.of, 100.0 * error.share);
    fill_radiance_factors(colour, bands, exitance, illuminant);
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
    if (const std::string unknown = unknown_reflectance(matrix); !unknown.empty())
        warnings.push_back(unknown);
    const double unseen = unseen_white(matrix.emission, illuminant);
    if (!reaches_far_enough(matrix.emission) && unseen > least_unseen_white)
        warnings.push_back(fmt::format(
            "the emission bands end at {:.6g} and {:.6g} nm: up to {:.3g} % of the white (X, Y or "
            "Z) of {} lies outside, where the sample's colour is not known",
            matrix.emission.from_nm, matrix.emission.to_nm(), 100.0 * unseen, name));
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
