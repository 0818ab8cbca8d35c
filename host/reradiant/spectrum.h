#pragma once

#include "reradiant/wavelength_grid.h"

#include <string>
#include <vector>

namespace reradiant {

/// A narrow emission line: a box of the given width and integral (spectral unit times nm).
struct SpectralLine {
    double centre_nm = 0.0;
    double width_nm = 1.0;
    double integral = 0.0;
};

/// A spectral quantity as a function of wavelength: the sum of a constant, piecewise linear
/// tables (constant outside their range), Gaussians, blackbodies and boxes. Boxes are kept
/// apart, so that a renderer can place fixed wavelengths on them.
class Spectrum {
public:
    Spectrum() = default; ///< zero everywhere

    static Spectrum constant(double value);
    /// Wavelengths strictly ascending and finite, values finite, same length >= 1 (a single
    /// point is a constant); std::invalid_argument names the first offending entry.
    static Spectrum table(std::vector<double> wavelengths_nm, std::vector<double> values);
    static Spectrum gaussian(double centre_nm, double sigma_nm, double peak);
    /// A box of width_nm with the given integral.
    static Spectrum line(double centre_nm, double width_nm, double integral);
    /// Planck's law, scaled so that the value at 560 nm is `value_at_560_nm`.
    static Spectrum blackbody(double kelvin, double value_at_560_nm);

    Spectrum& operator+=(const Spectrum& other);
    Spectrum scaled(double factor) const;
    /// Returns the spectrum without its boxes.
    Spectrum without_lines() const;

    /// Value at one wavelength, boxes included.
    double operator()(double wavelength_nm) const;
    /// Mean over [from, to], exact for tables, boxes and constants, to 1e-10 relative for
    /// Gaussians (erf) and blackbodies (quadrature).
    double average(double from_nm, double to_nm) const;
    std::vector<double> at(const std::vector<double>& wavelengths_nm) const;

    const std::vector<SpectralLine>& lines() const { return lines_; }
    /// True when the value does not depend on wavelength (so one number serves all).
    bool is_constant() const;
    bool is_zero() const;
    /// True when the value is 0 for every wavelength in [from, to] (Gaussians count as non-zero
    /// within 6 sigma only).
    bool is_zero_within(double from_nm, double to_nm) const;
    double minimum(double from_nm, double to_nm) const; ///< over tables' nodes and a 1 nm comb
    double maximum(double from_nm, double to_nm) const;
    /// Range that every table part covers with data: {0, inf} when there is no table part.
    double data_from_nm() const;
    double data_to_nm() const;
    /// Last wavelength that tables, Gaussians (8 sigma) and boxes describe; 0 when there are
    /// none of them.
    double described_to_nm() const;
    /// Returns the wavelengths at which a quadrature over the boxless part should be split: nodes
    /// of tables and Gaussians in steps of sigma; ascending, without repetition.
    std::vector<double> breakpoints_nm() const;

private:
    struct Table {
        std::vector<double> wavelengths_nm, values;
    };
    struct Gaussian {
        double centre_nm, sigma_nm, peak;
    };
    struct Blackbody {
        double kelvin, value_at_560_nm;
    };

    double constant_ = 0.0;
    std::vector<Table> tables_;
    std::vector<Gaussian> gaussians_;
    std::vector<Blackbody> blackbodies_;
    std::vector<SpectralLine> lines_;
};

} // namespace reradiant
