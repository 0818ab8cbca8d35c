#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace reradiant::svg {

using Chromaticity = std::array<double, 2>; ///< x, y

/// A colour in the diagram.
struct ChromaticityPoint {
    std::string title;                     ///< shown when the pointer rests on it
    std::string mark = {};                 ///< a short text beside it; may be empty
    std::size_t series = 0;                ///< gives its colour
    Chromaticity xy{};                     ///< not drawn where it is not finite
    std::optional<Chromaticity> from = {}; ///< a ring there, and a line from it to the point
};

/// A region with its name.
struct ChromaticityRegion {
    std::string name;
    std::vector<Chromaticity> corners; ///< in order around
};

struct ChromaticityDiagram {
    std::string title = {}, x_label = "x", y_label = "y";
    std::vector<double> nm;           ///< of the spectrum locus, ascending
    std::vector<Chromaticity> locus;  ///< as long as `nm`
    std::vector<std::string> series;  ///< names
    std::vector<Chromaticity> whites; ///< of each series, a cross
    std::vector<ChromaticityRegion> regions;
    std::vector<ChromaticityPoint> points;
};

/// The diagram as one SVG element, x from 0 to 0.8 and y from 0 to 0.9 to one scale.
/// std::invalid_argument where `locus` is not as long as `nm`, or a point is of no series.
std::string chromaticity_diagram(const ChromaticityDiagram& diagram);

} // namespace reradiant::svg
