#pragma once

#include "reradiant/colour_of_matrix.h"

#include <array>
#include <optional>
#include <string>

namespace reradiant {

/// Lightness, chroma and hue in degrees (0 to 360; 0 for grey) of a CIE 1976 Lab colour.
std::array<double, 3> lab_to_lch(const std::array<double, 3>& lab);

/// Colour differences of a sample from a reference, all of CIE 1976 Lab colours.
struct ColourDifferences {
    double cie1976 = 0.0;
    /// CIE 116-1995 with kL = 1, K1 = 0.045, K2 = 0.015 (graphic arts); not symmetric: its weights
    /// are the reference's.
    double cie1994 = 0.0;
    double ciede2000 = 0.0; ///< kL = kC = kH = 1
    double cmc21 = 0.0;     ///< CMC(2:1) of 1984, BS 6923; not symmetric either
};
ColourDifferences colour_differences(const std::array<double, 3>& reference,
                                     const std::array<double, 3>& sample);

/// Whiteness of ASTM E313 in the form of 1973, 3.388 Z - 3 Y for Y = 100 of the perfect diffuser
/// (that of later editions is `cie_whiteness`), and its yellowness, 100 (Cx X - Cz Z) / Y. Both are
/// defined for illuminants C and D65 and the observers of 1931 and 1964; elsewhere there is none.
struct E313 {
    double whiteness = 0.0, yellowness = 0.0;
};
std::optional<E313> astm_e313(const Xyz& xyz, const std::string& illuminant, Observer observer);

/// ISO brightness R457 (under illuminant C, ISO 2470-1) or D65 brightness (under D65, ISO 2470-2):
/// the mean of the total radiance factor in percent, weighted from 400 to 510 nm. Between bands the
/// factor is linear. None where the bands or the light do not reach over these wavelengths.
std::optional<double> r457(const MatrixColour& colour);

/// The CIE's special index of metamerism for a change of illuminant (CIE 15:2018, 9.2): the CIE
/// 1976 difference of two samples under a test lamp, where the sample's X, Y and Z are first
/// multiplied by what makes the two equal under the reference lamp.
double metamerism_index(const MatrixColour& reference_at_reference_lamp,
                        const MatrixColour& sample_at_reference_lamp,
                        const MatrixColour& reference_at_test_lamp,
                        const MatrixColour& sample_at_test_lamp);

} // namespace reradiant
