#pragma once

#include "reradiant/colour_of_matrix.h"
#include "reradiant/error.h"
#include "reradiant/spectrum.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// A `Lamp` is the light that a sample stands in.
struct Lamp {
    std::string name; ///< as the user wrote it, or that of its file
    Spectrum light;   ///< relative spectral irradiance
    /// The illuminant by which radiance factors under this lamp are weighted; empty: by the lamp
    /// itself.
    std::optional<Spectrum> weighted_by = {};
    /// Light below this was taken away on purpose, or is not meant to be there.
    double cut_below_nm = 0.0;
};

/// Returns the lamp that a text stands for; std::invalid_argument says what is wrong and which
/// lamps there are. The text is a sum, as in `D65+0.3*L:365`, of terms that a factor may precede:
/// - a CIE illuminant's name (see `illuminant` in colour.h);
/// - `D:KELVIN`, CIE daylight of that correlated colour temperature, 4000 to 25000 K;
/// - `P:KELVIN`, a black body, 500 to 1e6 K;
/// - `L:NM` or `L:NM:WIDTH`, a line: a box of WIDTH (1 nm where it is not given).
/// In a sum illuminants, daylight and black bodies have Y = factor in the scale of xyz_of, and a
/// line has the integral `factor` in nm, as in scene files.
/// `M0`, `M1` and `M2`, which stand alone, are the measurement conditions of ISO 13655: light of
/// illuminant A, of D50, and of A without what lies below 400 nm, all three weighted by D50.
Lamp lamp_from_text(const std::string& text);

/// Reads a lamp from any file of a spectrum; outside its data it is dark. Input Error, also where
/// it is negative or dark in the visible.
Lamp read_lamp(const std::filesystem::path& file);

/// Makes a lamp of a spectrum, dark outside its data; input Error at `at` as for a file.
Lamp lamp_of_spectrum(const std::string& name, const Spectrum& data, const SourcePosition& at);

/// Returns a spectrum cut off outside [from, to], where it is 0. Tables and boxes are cut exactly;
/// Gaussians and black bodies become tables of 1 nm. std::invalid_argument unless from < to, both
/// finite.
Spectrum cut_to(const Spectrum& spectrum, double from_nm, double to_nm);

/// The lamp without its light below `nm`; std::invalid_argument unless 200 <= nm <= 780.
Lamp without_ultraviolet(const Lamp& lamp, double nm);

/// CIE daylight of a correlated colour temperature from 4000 to 25000 K, Y = 1 in the scale of
/// xyz_of: CIE 15:2018, equations 4.7 to 4.12, with M1 and M2 rounded to three decimals as it asks.
/// Dark outside 300-830 nm. std::invalid_argument beyond these temperatures.
Spectrum cie_daylight(double kelvin);

/// A sentence where the observer sees almost nothing of the light of a lamp that colours are
/// relative to, as of `L:365` alone: the fluorescence that it excites is then many times as bright
/// as its white. Empty where it is seen.
std::string faint_white_warning(const Lamp& lamp, Observer observer);

/// What colour_warnings says of a matrix under a lamp: not of scatter, which any lamp shows.
std::vector<std::string> lamp_warnings(const ReradiationMatrix& matrix, const Lamp& lamp,
                                       Observer observer);

/// The share of a lamp's irradiance that lies below 400 nm, of that from 300 to 830 nm; NaN for a
/// lamp without light there.
double ultraviolet_share(const Spectrum& lamp);

} // namespace reradiant
