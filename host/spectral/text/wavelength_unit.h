#pragma once

#include "reradiant/error.h"

#include <optional>
#include <string>
#include <string_view>

namespace reradiant {

/// A unit of a spectral axis and how it becomes nm.
struct WavelengthUnit {
    std::string_view name = "nm";
    double factor = 1.0;     ///< nm = factor * x, or factor / x
    bool reciprocal = false; ///< wavenumbers, photon energies and frequencies descend in nm

    double to_nm(double x) const { return reciprocal ? factor / x : factor * x; }
};

/// The unit that the heading of an axis states: "nm", "Wavelength (um)", "lambda_nm", "A", "cm-1",
/// "Wavenumber", "inverse um", "MICROMETERS"; empty where it states none, and for titles with
/// numbers in them. A letter that may be a name (A, m, pm) is a unit where it is the whole heading,
/// in brackets, or behind a stroke, an underscore or "in".
std::optional<WavelengthUnit> stated_wavelength_unit(std::string_view heading);
/// True for a heading whose first word is "wavelength", "lambda", "wavenumber" and so on.
bool begins_with_axis_name(std::string_view heading);
/// True for the heading of a spectral axis: it states a unit or begins with "wavelength", "lambda".
bool names_wavelengths(std::string_view heading);
/// The word of a heading that is an axis of another kind ("Pixel", "Angle (deg)"), or empty, as for
/// titles that begin with such a word ("Energy saving lamp").
std::string stated_other_axis(std::string_view heading);
/// The word of a heading of values that is no linear scale of light or reflectance (absorbance,
/// decibels, Kubelka-Munk), or empty.
std::string stated_other_quantity(std::string_view heading);
/// True where the heading of values states percent: "%R", "R (%)", "reflectance_percent", "per
/// cent". A sign behind a digit ("Grey 50%") belongs to the number.
bool states_percent(std::string_view heading);

/// A `UnitSource` says where a unit of wavelength comes from: the heading of a file, the custom
/// that it is nm, or an interface that has no other.
enum class UnitSource { Stated, Assumed, Fixed };

/// Input Error unless some of the range lies where the program looks at light, 200 to 1000 nm: what
/// does not is in another unit, and would be a constant.
void require_plausible_range(double from_nm, double to_nm, UnitSource source,
                             const SourcePosition& at);

} // namespace reradiant
