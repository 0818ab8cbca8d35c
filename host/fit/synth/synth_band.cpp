#include "host/fit/synth/synth_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr double nm_per_cm = 1e7;
constexpr double table_from_nm = 150.0, table_to_nm = 1500.0, table_step_nm = 0.5;
/// Below this the log-normal has no digits left, and its limit is used.
constexpr double least_skewness = 1e-6;

} // namespace

double wavenumber_per_cm(double wavelength_nm) {
    return nm_per_cm / wavelength_nm;
}

double width_per_cm(double width_nm, double wavelength_nm) {
    return nm_per_cm * width_nm / (wavelength_nm * wavelength_nm);
}

double WavenumberBand::operator()(double wavelength_nm) const {
    const double to_red =
        (wavenumber_per_cm(peak_nm) - wavenumber_per_cm(wavelength_nm)) / width_per_cm;
    if (std::abs(skew - 1.0) < least_skewness)
        return std::exp(-4.0 * std::numbers::ln2 * to_red * to_red);
    const double argument = 1.0 + to_red * (skew * skew - 1.0) / skew;
    if (!(argument > 0.0))
        return 0.0;
    const double exponent = std::log(argument) / std::log(skew);
    return std::exp(-std::numbers::ln2 * exponent * exponent);
}

WavenumberBand mirrored(const WavenumberBand& band, double zero_zero_per_cm) {
    WavenumberBand image = band;
    image.peak_nm = nm_per_cm / (2.0 * zero_zero_per_cm - wavenumber_per_cm(band.peak_nm));
    image.skew = 1.0 / band.skew;
    return image;
}

Spectrum spectrum_of_bands(const std::vector<WavenumberBand>& bands, double peak) {
    if (bands.empty())
        throw std::invalid_argument("a spectrum needs at least one band");
    std::vector<double> nm, value;
    const int steps = static_cast<int>(std::lround((table_to_nm - table_from_nm) / table_step_nm));
    for (int k = 0; k <= steps; ++k) {
        nm.push_back(table_from_nm + k * table_step_nm);
        double sum = 0.0;
        for (const WavenumberBand& band : bands)
            sum += band.height * band(nm.back());
        value.push_back(sum);
    }
    value.front() = value.back() = 0.0;
    const double largest = *std::max_element(value.begin(), value.end());
    for (double& entry : value)
        entry *= largest > 0.0 ? peak / largest : 0.0;
    return Spectrum::table(std::move(nm), std::move(value));
}

} // namespace reradiant
