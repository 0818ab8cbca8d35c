#include "host/spectral/spectrum/spectrum_operations.h"

#include <algorithm>
#include <functional>

namespace reradiant {

namespace {

constexpr double FROM_NM = 200.0, TO_NM = 1200.0;
/// Wavelengths between which a function of these boxless spectra is taken as linear; ascending.
std::vector<double> nodes_of(std::initializer_list<const Spectrum*> spectra) {
    std::vector<double> nodes;
    for (double nm = FROM_NM; nm <= TO_NM; nm += 1.0)
        nodes.push_back(nm);
    for (const Spectrum* spectrum : spectra) {
        const std::vector<double> own = spectrum->breakpoints_nm();
        nodes.insert(nodes.end(), own.begin(), own.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

Spectrum table_of(const std::vector<double>& nodes, const std::function<double(double)>& value) {
    std::vector<double> values;
    for (const double nm : nodes)
        values.push_back(value(nm));
    return Spectrum::table(nodes, std::move(values));
}

/// The boxes of `lines` as they come through `filter`.
Spectrum filtered_lines(const std::vector<SpectralLine>& lines, const Spectrum& filter) {
    Spectrum sum;
    for (const SpectralLine& line : lines) {
        const double left = line.centre_nm - 0.5 * line.width_nm;
        const double share = filter.average(left, left + line.width_nm);
        if (share != 0.0)
            sum += Spectrum::line(line.centre_nm, line.width_nm, line.integral * share);
    }
    return sum;
}

/// The product of boxes with boxes: where they overlap.
Spectrum overlaps(const std::vector<SpectralLine>& a, const std::vector<SpectralLine>& b) {
    Spectrum sum;
    for (const SpectralLine& one : a)
        for (const SpectralLine& other : b) {
            const double left = std::max(one.centre_nm - 0.5 * one.width_nm,
                                         other.centre_nm - 0.5 * other.width_nm);
            const double right = std::min(one.centre_nm + 0.5 * one.width_nm,
                                          other.centre_nm + 0.5 * other.width_nm);
            if (right > left)
                sum += Spectrum::line(0.5 * (left + right), right - left,
                                      one.integral / one.width_nm * other.integral /
                                          other.width_nm * (right - left));
        }
    return sum;
}

} // namespace

Spectrum product(const Spectrum& a, const Spectrum& b) {
    if (a.is_constant() || b.is_constant())
        return a.is_constant() ? b.scaled(a(560.0)) : a.scaled(b(560.0));
    const Spectrum smooth_a = a.without_lines(), smooth_b = b.without_lines();
    Spectrum result = filtered_lines(a.lines(), smooth_b);
    result += filtered_lines(b.lines(), smooth_a);
    result += overlaps(a.lines(), b.lines());
    if (!smooth_a.is_zero() && !smooth_b.is_zero())
        result += table_of(nodes_of({&smooth_a, &smooth_b}),
                           [&](double nm) { return smooth_a(nm) * smooth_b(nm); });
    return result;
}

Spectrum cut_values(const Spectrum& spectrum, double low, double high) {
    const auto cut = [=](double value) { return std::clamp(value, low, high); };
    const Spectrum smooth = spectrum.without_lines();
    Spectrum result = smooth.is_constant() ? Spectrum::constant(cut(smooth(560.0)))
                                           : table_of(nodes_of({&smooth}),
                                                      [&](double nm) { return cut(smooth(nm)); });
    for (const SpectralLine& line : spectrum.lines())
        result += Spectrum::line(line.centre_nm, line.width_nm,
                                 cut(line.integral / line.width_nm) * line.width_nm);
    return result;
}

} // namespace reradiant
