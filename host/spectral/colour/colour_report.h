#pragma once

#include "host/spectral/colour/colour_indices.h"
#include "host/spectral/colour/colour_polygons.h"
#include "host/spectral/colour/lamp.h"
#include "host/spectral/colour/lamp_colours.h"
#include "reradiant/colour_of_matrix.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace reradiant {

struct PolygonVerdict {
    ColourPolygon polygon;
    PolygonResult result;
};

/// A colour and the indices that are defined for its lamp and observer.
struct IndexedColour {
    MatrixColour colour;
    std::array<double, 3> lch{};
    std::optional<Whiteness> whiteness; ///< of D65 and C, observers of 1931 and 1964
    std::optional<E313> e313;           ///< the same
    std::optional<double> r457;         ///< of D65 and C
};

/// A `QuantityInterval` says how well a number or several of a colour are known: standard errors
/// and the ends of 95 % intervals. An interval of a hue may end below 0 or above 360 degrees.
struct QuantityInterval {
    std::string name; ///< as in `colour --json`
    std::vector<double> standard_error, low, high;
};

/// Intervals that follow from the uncertainty of a matrix, by two ways that agree where the colour
/// is a smooth function over the uncertainty.
struct ColourIntervals {
    std::vector<QuantityInterval> linearised, drawn;
    std::vector<QuantityInterval> uv_excluded_linearised, uv_excluded_drawn;
};

/// All that is said about a matrix under one lamp, for one observer.
struct ColourReport : IndexedColour {
    std::string illuminant; ///< the lamp's name
    Observer observer = Observer::Cie1931Deg2;
    double ultraviolet_share = 0.0;
    /// Without what light below uv_excluded_from_nm excites.
    IndexedColour uv_excluded;
    std::optional<ColourDifferences> differences; ///< to another matrix, when there is one
    std::optional<double> metamerism;             ///< of the two, from the first lamp to this
    std::vector<PolygonVerdict> polygons;
    std::optional<ColourIntervals> intervals; ///< set_intervals, where a covariance is known
    std::vector<std::string> warnings;

    /// Emission band of the largest total radiance factor; NaN is never the largest.
    std::size_t brightest_band() const;
};

/// The filter that paper laboratories exclude ultraviolet light with.
inline constexpr double uv_excluded_from_nm = 420.0;

/// A `ColourReporter` reports any number of matrices under one lamp, for one observer. What it
/// sums for one it keeps for the next.
class ColourReporter {
public:
    ColourReporter(Lamp lamp, ColourSum sum, Observer observer);

    const Lamp& lamp() const { return lamp_; }
    Observer observer() const { return observer_; }
    /// Colour, indices and warnings, those of `scatter` (scatter_warnings of the matrix) first.
    /// std::invalid_argument as colour_of_matrix.
    ColourReport report_of(const ReradiationMatrix& matrix, std::vector<std::string> scatter);

private:
    Lamp lamp_;
    Observer observer_;
    LampColours whole_, uv_excluded_;
    double ultraviolet_share_;
    std::string faint_white_; ///< a warning, or empty
};

/// The report of one matrix.
ColourReport colour_report(const ReradiationMatrix& matrix, const Lamp& lamp, ColourSum sum,
                           Observer observer = Observer::Cie1931Deg2);

/// Sets the differences of a report from that of a reference under the same lamp.
void compare_with(ColourReport& report, const ColourReport& reference);

/// Returns what `colour --json` writes for one illuminant.
nlohmann::ordered_json colour_report_json(const ColourReport& report);

/// Tests the polygons of the report's lamp. They are drawn in the diagram of the observer of 1931:
/// for another one there are none.
void test_polygons(ColourReport& report, const std::vector<ColourPolygon>& polygons);

/// Returns the key of a report in JSON: LAMP, or LAMP/OBSERVER where there are several observers.
std::string report_key(const ColourReport& report, std::size_t observers);

} // namespace reradiant
