#include "reradiant/spectrum.h"

#include "host/spectral/spectrum/quadrature.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace reradiant {

namespace {

// CODATA 2018, exact since the SI of 2019: h c / k in nm K.
constexpr double second_radiation_constant_nm_k = 1.438776877e7;
constexpr double blackbody_reference_nm = 560.0;
constexpr double lowest_blackbody_kelvin = 100.0;
constexpr double gaussian_reach_sigma = 6.0;

void require(bool holds, const std::string& sentence) {
    if (!holds)
        throw std::invalid_argument(sentence);
}

/// log(exp(x) - 1) for x > 0 without overflow.
double log_expm1(double x) {
    return x > 30.0 ? x + std::log1p(-std::exp(-x)) : std::log(std::expm1(x));
}

/// Planck's radiance over its value at 560 nm, in logarithms: at 100 K the two differ by 1e90.
double blackbody_ratio(double kelvin, double wavelength_nm) {
    if (!(wavelength_nm > 0.0))
        return 0.0;
    const double c2 = second_radiation_constant_nm_k / kelvin;
    return std::exp(5.0 * std::log(blackbody_reference_nm / wavelength_nm) +
                    log_expm1(c2 / blackbody_reference_nm) - log_expm1(c2 / wavelength_nm));
}

double gaussian_value(double centre_nm, double sigma_nm, double wavelength_nm) {
    const double t = (wavelength_nm - centre_nm) / sigma_nm;
    return std::exp(-0.5 * t * t);
}

/// Integral of a unit-peak Gaussian. Quadrature where the range is short and erfc on the side
/// where it is small, so that neither cancels.
double gaussian_integral(double centre_nm, double sigma_nm, double from_nm, double to_nm) {
    if (to_nm - from_nm < 0.5 * sigma_nm)
        return gauss_legendre_8(from_nm, to_nm,
                                [&](double l) { return gaussian_value(centre_nm, sigma_nm, l); });
    const double scale = sigma_nm * std::sqrt(0.5 * 3.14159265358979323846);
    const double a = (from_nm - centre_nm) / (sigma_nm * std::sqrt(2.0));
    const double b = (to_nm - centre_nm) / (sigma_nm * std::sqrt(2.0));
    if (a > 0.0)
        return scale * (std::erfc(a) - std::erfc(b));
    if (b < 0.0)
        return scale * (std::erfc(-b) - std::erfc(-a));
    return scale * (std::erf(b) - std::erf(a));
}

double blackbody_integral(double kelvin, double from_nm, double to_nm) {
    // 2.5 nm panels: 8 points are exact to 1e-13 down to 100 K at 300 nm.
    const int panels = std::max(1, static_cast<int>(std::ceil((to_nm - from_nm) / 2.5)));
    const double width = (to_nm - from_nm) / panels;
    double sum = 0.0;
    for (int panel = 0; panel < panels; ++panel)
        sum += gauss_legendre_8(from_nm + panel * width, from_nm + (panel + 1) * width,
                                [&](double l) { return blackbody_ratio(kelvin, l); });
    return sum;
}

double table_value(const std::vector<double>& nodes, const std::vector<double>& values, double l) {
    if (!(l > nodes.front()))
        return values.front();
    if (l >= nodes.back())
        return values.back();
    const auto upper =
        static_cast<std::size_t>(std::upper_bound(nodes.begin(), nodes.end(), l) - nodes.begin());
    const double t = (l - nodes[upper - 1]) / (nodes[upper] - nodes[upper - 1]);
    return (1.0 - t) * values[upper - 1] + t * values[upper];
}

/// Trapezoids between the table's own nodes: exact for a piecewise linear function.
double table_integral(const std::vector<double>& nodes, const std::vector<double>& values,
                      double from_nm, double to_nm) {
    auto next = std::upper_bound(nodes.begin(), nodes.end(), from_nm);
    double left = from_nm, left_value = table_value(nodes, values, from_nm), sum = 0.0;
    for (; next != nodes.end() && *next < to_nm; ++next) {
        const double value = values[static_cast<std::size_t>(next - nodes.begin())];
        sum += 0.5 * (left_value + value) * (*next - left);
        left = *next;
        left_value = value;
    }
    return sum + 0.5 * (left_value + table_value(nodes, values, to_nm)) * (to_nm - left);
}

double box_overlap_nm(const SpectralLine& line, double from_nm, double to_nm) {
    const double overlap = std::min(to_nm, line.centre_nm + 0.5 * line.width_nm) -
                           std::max(from_nm, line.centre_nm - 0.5 * line.width_nm);
    return std::max(0.0, overlap);
}

} // namespace

Spectrum Spectrum::constant(double value) {
    require(std::isfinite(value), fmt::format("{} is not a finite value", value));
    Spectrum spectrum;
    spectrum.constant_ = value;
    return spectrum;
}

Spectrum Spectrum::table(std::vector<double> wavelengths_nm, std::vector<double> values) {
    require(!wavelengths_nm.empty(), "a spectrum needs at least one wavelength");
    require(wavelengths_nm.size() == values.size(),
            fmt::format("{} wavelengths but {} values", wavelengths_nm.size(), values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
        require(std::isfinite(wavelengths_nm[i]),
                fmt::format("wavelength {} ({}) is not finite", i + 1, wavelengths_nm[i]));
        require(std::isfinite(values[i]),
                fmt::format("value {} ({}) is not finite", i + 1, values[i]));
        require(i == 0 || wavelengths_nm[i] > wavelengths_nm[i - 1],
                fmt::format("wavelength {} ({} nm) does not ascend", i + 1, wavelengths_nm[i]));
    }
    if (values.size() == 1)
        return constant(values.front());
    Spectrum spectrum;
    spectrum.tables_.push_back({std::move(wavelengths_nm), std::move(values)});
    return spectrum;
}

Spectrum Spectrum::gaussian(double centre_nm, double sigma_nm, double peak) {
    require(std::isfinite(centre_nm) && std::isfinite(peak) && std::isfinite(sigma_nm) &&
                sigma_nm > 0.0,
            "a Gaussian needs a finite centre and peak and a sigma above 0");
    Spectrum spectrum;
    spectrum.gaussians_.push_back({centre_nm, sigma_nm, peak});
    return spectrum;
}

Spectrum Spectrum::line(double centre_nm, double width_nm, double integral) {
    require(std::isfinite(centre_nm) && std::isfinite(integral) && std::isfinite(width_nm) &&
                width_nm > 0.0,
            "a line needs a finite centre and integral and a width above 0");
    Spectrum spectrum;
    spectrum.lines_.push_back({centre_nm, width_nm, integral});
    return spectrum;
}

Spectrum Spectrum::blackbody(double kelvin, double value_at_560_nm) {
    require(std::isfinite(kelvin) && kelvin >= lowest_blackbody_kelvin,
            fmt::format("a blackbody of {} K is below {} K and gives no light here", kelvin,
                        lowest_blackbody_kelvin));
    require(std::isfinite(value_at_560_nm), "the value of a blackbody is not finite");
    Spectrum spectrum;
    spectrum.blackbodies_.push_back({kelvin, value_at_560_nm});
    return spectrum;
}

Spectrum& Spectrum::operator+=(const Spectrum& other) {
    const auto append = [](auto& to, const auto& from) {
        const auto copy = from; // `other` may be this object
        to.insert(to.end(), copy.begin(), copy.end());
    };
    constant_ += other.constant_;
    append(tables_, other.tables_);
    append(gaussians_, other.gaussians_);
    append(blackbodies_, other.blackbodies_);
    append(lines_, other.lines_);
    return *this;
}

Spectrum Spectrum::scaled(double factor) const {
    require(std::isfinite(factor), fmt::format("the scale {} is not finite", factor));
    Spectrum result = *this;
    result.constant_ *= factor;
    for (Table& table : result.tables_)
        for (double& value : table.values)
            value *= factor;
    for (Gaussian& gaussian : result.gaussians_)
        gaussian.peak *= factor;
    for (Blackbody& blackbody : result.blackbodies_)
        blackbody.value_at_560_nm *= factor;
    for (SpectralLine& line : result.lines_)
        line.integral *= factor;
    return result;
}

Spectrum Spectrum::without_lines() const {
    Spectrum result = *this;
    result.lines_.clear();
    return result;
}

double Spectrum::operator()(double wavelength_nm) const {
    double sum = constant_;
    for (const Table& table : tables_)
        sum += table_value(table.wavelengths_nm, table.values, wavelength_nm);
    for (const Gaussian& g : gaussians_)
        sum += g.peak * gaussian_value(g.centre_nm, g.sigma_nm, wavelength_nm);
    for (const Blackbody& b : blackbodies_)
        sum += b.value_at_560_nm * blackbody_ratio(b.kelvin, wavelength_nm);
    for (const SpectralLine& line : lines_)
        if (wavelength_nm >= line.centre_nm - 0.5 * line.width_nm &&
            wavelength_nm < line.centre_nm + 0.5 * line.width_nm)
            sum += line.integral / line.width_nm;
    return sum;
}

double Spectrum::average(double from_nm, double to_nm) const {
    if (from_nm == to_nm)
        return (*this)(from_nm);
    if (from_nm > to_nm)
        std::swap(from_nm, to_nm);
    double integral = 0.0;
    for (const Table& table : tables_)
        integral += table_integral(table.wavelengths_nm, table.values, from_nm, to_nm);
    for (const Gaussian& g : gaussians_)
        integral += g.peak * gaussian_integral(g.centre_nm, g.sigma_nm, from_nm, to_nm);
    for (const Blackbody& b : blackbodies_)
        integral += b.value_at_560_nm * blackbody_integral(b.kelvin, from_nm, to_nm);
    for (const SpectralLine& line : lines_)
        integral += line.integral / line.width_nm * box_overlap_nm(line, from_nm, to_nm);
    return constant_ + integral / (to_nm - from_nm);
}

std::vector<double> Spectrum::at(const std::vector<double>& wavelengths_nm) const {
    std::vector<double> values;
    values.reserve(wavelengths_nm.size());
    for (const double wavelength_nm : wavelengths_nm)
        values.push_back((*this)(wavelength_nm));
    return values;
}

bool Spectrum::is_constant() const {
    const auto flat = [](const Table& table) {
        return std::all_of(table.values.begin(), table.values.end(),
                           [&](double value) { return value == table.values.front(); });
    };
    return std::all_of(tables_.begin(), tables_.end(), flat) &&
           std::all_of(gaussians_.begin(), gaussians_.end(),
                       [](const Gaussian& g) { return g.peak == 0.0; }) &&
           std::all_of(blackbodies_.begin(), blackbodies_.end(),
                       [](const Blackbody& b) { return b.value_at_560_nm == 0.0; }) &&
           std::all_of(lines_.begin(), lines_.end(),
                       [](const SpectralLine& line) { return line.integral == 0.0; });
}

bool Spectrum::is_zero() const {
    return is_constant() && (*this)(blackbody_reference_nm) == 0.0;
}

bool Spectrum::is_zero_within(double from_nm, double to_nm) const {
    if (constant_ != 0.0)
        return is_zero();
    for (const Table& table : tables_) {
        if (table_value(table.wavelengths_nm, table.values, from_nm) != 0.0 ||
            table_value(table.wavelengths_nm, table.values, to_nm) != 0.0)
            return false;
        for (std::size_t i = 0; i < table.values.size(); ++i)
            if (table.wavelengths_nm[i] > from_nm && table.wavelengths_nm[i] < to_nm &&
                table.values[i] != 0.0)
                return false;
    }
    for (const Gaussian& g : gaussians_)
        if (g.peak != 0.0 && g.centre_nm + gaussian_reach_sigma * g.sigma_nm >= from_nm &&
            g.centre_nm - gaussian_reach_sigma * g.sigma_nm <= to_nm)
            return false;
    for (const Blackbody& b : blackbodies_)
        if (b.value_at_560_nm != 0.0)
            return false;
    for (const SpectralLine& line : lines_)
        if (line.integral != 0.0 && box_overlap_nm(line, from_nm, to_nm) > 0.0)
            return false;
    return true;
}

namespace {

/// Places where an extremum can lie: both ends, given nodes, and a 1 nm comb between.
std::vector<double> candidates_nm(std::vector<double> nodes, double from_nm, double to_nm) {
    std::erase_if(nodes, [&](double l) { return !(l > from_nm && l < to_nm); });
    nodes.push_back(from_nm);
    nodes.push_back(to_nm);
    for (double l = std::ceil(from_nm); l < to_nm; l += 1.0)
        nodes.push_back(l);
    return nodes;
}

} // namespace

double Spectrum::minimum(double from_nm, double to_nm) const {
    double result = std::numeric_limits<double>::infinity();
    std::vector<double> nodes = breakpoints_nm();
    for (const SpectralLine& line : lines_)
        nodes.insert(nodes.end(), {line.centre_nm, line.centre_nm - line.width_nm,
                                   line.centre_nm + line.width_nm});
    for (const double l : candidates_nm(std::move(nodes), from_nm, to_nm))
        result = std::min(result, (*this)(l));
    return result;
}

double Spectrum::maximum(double from_nm, double to_nm) const {
    return -scaled(-1.0).minimum(from_nm, to_nm);
}

double Spectrum::data_from_nm() const {
    double from = 0.0;
    for (const Table& table : tables_)
        from = std::max(from, table.wavelengths_nm.front());
    return from;
}

double Spectrum::data_to_nm() const {
    double to = std::numeric_limits<double>::infinity();
    for (const Table& table : tables_)
        to = std::min(to, table.wavelengths_nm.back());
    return to;
}

double Spectrum::described_to_nm() const {
    double to = 0.0;
    for (const Table& table : tables_)
        to = std::max(to, table.wavelengths_nm.back());
    for (const Gaussian& g : gaussians_)
        to = std::max(to, g.centre_nm + 8.0 * g.sigma_nm);
    for (const SpectralLine& line : lines_)
        to = std::max(to, line.centre_nm + 0.5 * line.width_nm);
    return to;
}

std::vector<double> Spectrum::breakpoints_nm() const {
    std::vector<double> points;
    for (const Table& table : tables_)
        points.insert(points.end(), table.wavelengths_nm.begin(), table.wavelengths_nm.end());
    for (const Gaussian& g : gaussians_)
        for (int k = -8; k <= 8; ++k)
            points.push_back(g.centre_nm + k * g.sigma_nm);
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

} // namespace reradiant
