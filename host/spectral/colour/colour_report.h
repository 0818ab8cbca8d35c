#pragma once

#include "host/spectral/colour/colour_polygons.h"
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

/// All that is said about a matrix under one illuminant.
struct ColourReport {
    std::string illuminant;
    MatrixColour colour;
    std::optional<Whiteness> whiteness; ///< only where it is defined: D65 and C
    std::optional<double> ciede2000;    ///< to another matrix, when there is one
    std::vector<PolygonVerdict> polygons;
    std::vector<std::string> warnings;

    /// Emission band of the largest total radiance factor; NaN is never the largest.
    std::size_t brightest_band() const;
};

/// Colour, whiteness and warnings; `name` is that of the illuminant. std::invalid_argument as
/// colour_of_matrix.
ColourReport colour_report(const ReradiationMatrix& matrix, const std::string& name,
                           const Spectrum& illuminant, ColourSum sum);

/// Returns what `colour --json` writes for one illuminant.
nlohmann::ordered_json colour_report_json(const ColourReport& report);

} // namespace reradiant
