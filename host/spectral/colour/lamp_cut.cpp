#include "host/spectral/colour/lamp.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace reradiant {

namespace {

/// The width of the step to 0 at a cut.
constexpr double just_outside_nm = 1e-6;

/// The nodes within the range, whose ends are two of them; ascending.
std::vector<double> nodes_within(std::vector<double> nodes_nm, double from_nm, double to_nm) {
    std::erase_if(nodes_nm, [&](double nm) {
        return !(nm > from_nm + just_outside_nm && nm < to_nm - just_outside_nm);
    });
    nodes_nm.insert(nodes_nm.begin(), from_nm);
    nodes_nm.push_back(to_nm);
    return nodes_nm;
}

/// True when the spectrum is linear between the nodes; told by their thirds, which no curve of a
/// Gaussian or black body meets by chance at every node.
bool is_linear_between(const std::vector<double>& nodes_nm, const Spectrum& spectrum) {
    constexpr double rounding = 1e-12;
    for (std::size_t k = 1; k < nodes_nm.size(); ++k) {
        const double left = nodes_nm[k - 1], right = nodes_nm[k], t = 1.0 / 3.0;
        const double line = (1.0 - t) * spectrum(left) + t * spectrum(right);
        const double value = spectrum((1.0 - t) * left + t * right);
        if (std::abs(value - line) > rounding * (std::abs(value) + std::abs(line)))
            return false;
    }
    return true;
}

std::vector<double> with_nanometres(std::vector<double> nodes_nm) {
    const double from_nm = nodes_nm.front(), to_nm = nodes_nm.back();
    for (double nm = std::ceil(from_nm); nm < to_nm; nm += 1.0)
        nodes_nm.push_back(nm);
    std::sort(nodes_nm.begin(), nodes_nm.end());
    nodes_nm.erase(std::unique(nodes_nm.begin(), nodes_nm.end()), nodes_nm.end());
    return nodes_nm;
}

/// The boxes' parts within the range.
Spectrum cut_lines(const std::vector<SpectralLine>& lines, double from_nm, double to_nm) {
    Spectrum result;
    for (const SpectralLine& line : lines) {
        const double left = std::max(from_nm, line.centre_nm - 0.5 * line.width_nm);
        const double right = std::min(to_nm, line.centre_nm + 0.5 * line.width_nm);
        if (right > left)
            result += Spectrum::line(0.5 * (left + right), right - left,
                                     line.integral * (right - left) / line.width_nm);
    }
    return result;
}

} // namespace

Spectrum cut_to(const Spectrum& spectrum, double from_nm, double to_nm) {
    if (!(std::isfinite(from_nm) && std::isfinite(to_nm) && from_nm < to_nm))
        throw std::invalid_argument(
            fmt::format("a spectrum has no range from {} to {} nm", from_nm, to_nm));
    Spectrum result = cut_lines(spectrum.lines(), from_nm, to_nm);
    const Spectrum smooth = spectrum.without_lines();
    if (smooth.is_zero())
        return result;
    std::vector<double> nodes = nodes_within(smooth.breakpoints_nm(), from_nm, to_nm);
    if (!is_linear_between(nodes, smooth))
        nodes = with_nanometres(std::move(nodes));
    std::vector<double> values = smooth.at(nodes);
    nodes.insert(nodes.begin(), from_nm - just_outside_nm);
    values.insert(values.begin(), 0.0);
    nodes.push_back(to_nm + just_outside_nm);
    values.push_back(0.0);
    return result += Spectrum::table(std::move(nodes), std::move(values));
}

} // namespace reradiant
