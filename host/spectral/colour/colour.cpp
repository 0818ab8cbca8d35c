#include "reradiant/colour.h"

#include "host/spectral/spectrum/quadrature.h"
#include "host/spectral/text/number_table.h"
#include "reradiant/paths.h"
#include "reradiant/spectral_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

/// Names as the files in spectra/illuminants are called; E needs no file.
constexpr std::array illuminant_names = {
    "A",      "B",      "C",      "D50",     "D55",      "D60",    "D65",    "D75",    "E",
    "ID50",   "ID65",   "FL1",    "FL2",     "FL3",      "FL4",    "FL5",    "FL6",    "FL7",
    "FL8",    "FL9",    "FL10",   "FL11",    "FL12",     "FL3.1",  "FL3.2",  "FL3.3",  "FL3.4",
    "FL3.5",  "FL3.6",  "FL3.7",  "FL3.8",   "FL3.9",    "FL3.10", "FL3.11", "FL3.12", "FL3.13",
    "FL3.14", "FL3.15", "HP1",    "HP2",     "HP3",      "HP4",    "HP5",    "LED-B1", "LED-B2",
    "LED-B3", "LED-B4", "LED-B5", "LED-BH1", "LED-RGB1", "LED-V1", "LED-V2"};

/// A colour matching function over [from, to], zero outside its table: exact for its linear pieces.
struct MatchingFunction {
    Spectrum curve;
    double from_nm = 0.0, to_nm = 0.0;

    double integral(double a, double b) const {
        a = std::max(a, from_nm);
        b = std::min(b, to_nm);
        return b > a ? curve.average(a, b) * (b - a) : 0.0;
    }
};

struct StandardEye {
    std::array<MatchingFunction, 3> functions;
    double integral_of_y = 1.0;
};

const StandardEye& standard_eye() {
    static const StandardEye result = [] {
        const ColourMatching& table = cie_1931_2_degree();
        const double from = table.wavelengths_nm.front(), to = table.wavelengths_nm.back();
        StandardEye made{
            {MatchingFunction{Spectrum::table(table.wavelengths_nm, table.x), from, to},
             MatchingFunction{Spectrum::table(table.wavelengths_nm, table.y), from, to},
             MatchingFunction{Spectrum::table(table.wavelengths_nm, table.z), from, to}},
            1.0};
        made.integral_of_y = made.functions[1].integral(from, to);
        return made;
    }();
    return result;
}

/// Returns the wavelengths at which the product of a spectrum and the observer has kinks, within
/// the observer's range.
std::vector<double> pieces_nm(const Spectrum& spectrum) {
    const std::vector<double>& nodes = cie_1931_2_degree().wavelengths_nm;
    std::vector<double> points = spectrum.breakpoints_nm();
    std::erase_if(points, [&](double l) { return !(l > nodes.front() && l < nodes.back()); });
    points.insert(points.end(), nodes.begin(), nodes.end());
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

} // namespace

std::vector<Xyz> xyz_weights(const WavelengthGrid& grid) {
    std::vector<Xyz> weights;
    for (int band = 0; band < grid.count; ++band) {
        Xyz weight{};
        for (std::size_t c = 0; c < 3; ++c)
            weight[c] = standard_eye().functions[c].integral(grid.lower_edge_nm(band),
                                                             grid.upper_edge_nm(band)) /
                        standard_eye().integral_of_y;
        weights.push_back(weight);
    }
    return weights;
}

Xyz xyz_of(const Spectrum& spectrum) {
    const StandardEye& eye = standard_eye();
    const Spectrum smooth = spectrum.without_lines();
    const std::vector<double> pieces = pieces_nm(smooth);
    Xyz sum{};
    for (std::size_t piece = 0; piece + 1 < pieces.size(); ++piece)
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += gauss_legendre_8(pieces[piece], pieces[piece + 1], [&](double l) {
                return smooth(l) * eye.functions[c].curve(l);
            });
    for (const SpectralLine& line : spectrum.lines())
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += line.integral / line.width_nm *
                      eye.functions[c].integral(line.centre_nm - 0.5 * line.width_nm,
                                                line.centre_nm + 0.5 * line.width_nm);
    for (double& component : sum)
        component /= eye.integral_of_y;
    return sum;
}

Spectrum illuminant(const std::string& name) {
    if (std::find(illuminant_names.begin(), illuminant_names.end(), name) == illuminant_names.end())
        throw std::invalid_argument(fmt::format("there is no illuminant '{}'; there are {}", name,
                                                fmt::join(illuminant_names, ", ")));
    if (name == "E")
        return Spectrum::constant(100.0);
    NumberTable table = read_number_table(spectra_directory() / "illuminants" / (name + ".csv"), 2);
    // There is no light where the CIE gives no values, rather than the last value for ever.
    constexpr double just_outside_nm = 1e-6;
    std::vector<double>& nm = table.columns[0];
    std::vector<double>& power = table.columns[1];
    nm.insert(nm.begin(), nm.front() - just_outside_nm);
    power.insert(power.begin(), 0.0);
    nm.push_back(nm.back() + just_outside_nm);
    power.push_back(0.0);
    return Spectrum::table(std::move(nm), std::move(power));
}

Spectrum illuminant_with_luminance(const std::string& name, double y) {
    const Spectrum relative = illuminant(name);
    return relative.scaled(y / xyz_of(relative)[1]);
}

} // namespace reradiant
