#pragma once

#include "reradiant/colour.h"
#include "reradiant/reradiation.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// An `Observer` is one of those whose colour matching functions the CIE publishes: of 1931 and
/// 1964 (ISO/CIE 11664-1, 360-830 nm), and of 2015, from cone fundamentals (CIE 170-2,
/// 390-830 nm).
enum class Observer { Cie1931Deg2, Cie1964Deg10, Cie2015Deg2, Cie2015Deg10 };
/// The colour matching functions of an observer, as `cie_1931_2_degree` has them; read once.
/// Outside their table they are zero.
const ColourMatching& colour_matching(Observer observer);
/// Returns the observer called 1931-2, 1964-10, 2015-2 or 2015-10; std::invalid_argument lists
/// these for another name.
Observer observer_named(const std::string& name);
std::string observer_name(Observer observer);
/// True for the observers of a field of 10 degrees.
bool is_10_degree(Observer observer);

/// A `ColourSum` says how a matrix's colour is summed over wavelengths.
enum class ColourSum {
    /// Plain sums over the emission bands' centres, as bispectral instruments report colours (ASTM
    /// E2152): the illuminant is taken at band centres too.
    Bands,
    /// Sums over 1 nm from 360 to 780 nm as ASTM E308 has them: reflectance and fluorescence are
    /// interpolated between the bands by Lagrange's polynomials (ASTM E2022: cubic, quadratic at
    /// the ends, the last value beyond). The narrow lines of a lamp count in full, also as
    /// excitation.
    E308,
    /// Plain sums, unless the lamp has lines (boxes) or they misjudge it: then as E308, but over
    /// the bands' own range where
    /// that ends within 400 to 700 nm. See plain_sums_misjudge.
    Automatic,
};

/// `ColourConditions` are what a colour depends on beside the sample and the light that it stands
/// in.
struct ColourConditions {
    Observer observer = Observer::Cie1931Deg2;
    /// The light by which tristimulus values are weighted, where that is not the light that the
    /// sample stands in: an instrument measures radiance factors under its lamp and weights them by
    /// an illuminant (ISO 13655). Light of wavelengths that the lamp lacks is not known then, and
    /// counts as none where it is re-radiated.
    std::optional<Spectrum> weighted_by = {};
    /// Light below this excites nothing; it is reflected as ever. What a colour loses by that is
    /// the share of fluorescence that ultraviolet light excites.
    double excites_from_nm = 0.0;
};

/// A `LampError` says how far plain sums at band centres are off for a lamp, compared with sums
/// over 1 nm in the same bands. `share` is the largest of the errors of X, Y and Z of the lamp's
/// own white, each relative to itself, and of the luminance that its light excites, relative to the
/// colour's. A lamp with lines that band centres hit or miss is off by per cents, a smooth one on
/// bands of 10 nm by less than 0.11 %.
struct LampError {
    double share = 0.0;
    std::string of; ///< "lamp's own white (Z)" or "fluorescence"
};
LampError plain_sums_misjudge(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                              const ColourConditions& conditions = {});
/// Automatic sums over 1 nm where the share of LampError is above this.
inline constexpr double most_misjudged = 0.002;

/// The colour of a matrix under one illuminant, for one observer.
struct MatrixColour {
    Xyz xyz{};                     ///< perfect diffuser Y = 100
    Xyz white{};                   ///< of the perfect diffuser, Y = 100
    double luminance_reflected{};  ///< share of xyz[1] that was reflected, not re-radiated
    std::array<double, 2> xy{};    ///< NaN when nothing is seen
    std::array<double, 3> lab{};   ///< CIE 1976, against `white`
    std::vector<double> nm;        ///< centres of the emission bands
    std::vector<double> reflected; ///< beta_R, reflected radiance factor per emission band
    /// beta_L, the luminescent radiance factor; NaN where the illuminant is dark.
    std::vector<double> luminescent;
    std::vector<double> total; ///< beta_T = beta_R + beta_L; above 1 is legal
    /// True when the sums are over 1 nm. Radiance factors are then those of the bands' mean light.
    bool at_nanometres = false;
    /// The reason where Automatic chose that, as it does for lamps with lines: a sentence without
    /// the lamp's name.
    std::string reason;
};

/// Raw values: negative and anti-Stokes entries count as they are. Where an emission band has no
/// excitation band of its wavelength, the reflectance between its neighbours stands in (see
/// ReradiationMatrix::reflectance). std::invalid_argument when the emission bands see none of the
/// illuminant's visible light.
MatrixColour colour_of_matrix(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                              ColourSum sum, const ColourConditions& conditions = {});

/// Returns what a reader of the colour must know: excitation below the start of the illuminant's
/// table (380 nm for lamps) is dark, unless it is so on purpose, reflectance goes on beyond the
/// excitation bands, the emission bands leave out a part of the lamp's white, scatter stands out.
std::vector<std::string> colour_warnings(const ReradiationMatrix& matrix,
                                         const Spectrum& illuminant, const std::string& name,
                                         Observer observer = Observer::Cie1931Deg2,
                                         double dark_on_purpose_below_nm = 0.0);

/// CIE whiteness and tint for the observers of 1931 and 1964 (CIE 15:2018, equations 9.1 to 9.3),
/// defined for D65 and used for C.
struct Whiteness {
    double whiteness = 0.0, tint = 0.0;
    /// 40 < W < 5 Y - 280 and -4 < T < 2: outside, the numbers do not describe a white.
    bool within_limits = false;
};
Whiteness cie_whiteness(const Xyz& xyz, const Xyz& white,
                        Observer observer = Observer::Cie1931Deg2);

} // namespace reradiant
