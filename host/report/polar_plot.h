#pragma once

#include <string>
#include <vector>

namespace reradiant::svg {

/// One curve of a polar plot; angles in degrees from the normal, -90 to 90, or -180 to 180 with
/// what lies beneath the surface, ascending. NaN is a gap.
struct PolarSeries {
    std::string label;
    std::vector<double> angle_deg, value;
};

/// A half disk, a whole one where something lies beneath, with the normal upwards and the radius
/// logarithmic over four decades beneath the largest value, so that a lobe and the body beside it
/// are both seen. Values that are not above the smallest radius, or not finite, are gaps.
/// `marked_deg` draws an arrow in from an angle. std::invalid_argument when the lengths of a series
/// disagree.
std::string polar_plot(const std::string& title, const std::vector<PolarSeries>& series,
                       double marked_deg);

} // namespace reradiant::svg
