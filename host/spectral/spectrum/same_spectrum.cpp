#include "host/spectral/spectrum/same_spectrum.h"

#include <algorithm>

namespace reradiant {

namespace {

constexpr int comb_from_nm = 100, comb_to_nm = 3000, comb_step_nm = 10;

bool same_line(const SpectralLine& a, const SpectralLine& b) {
    return a.centre_nm == b.centre_nm && a.width_nm == b.width_nm && a.integral == b.integral;
}

} // namespace

bool same_spectrum(const Spectrum& a, const Spectrum& b) {
    if (a.is_constant() || b.is_constant())
        return a.is_constant() && b.is_constant() && a(comb_from_nm) == b(comb_from_nm);
    if (!std::ranges::equal(a.lines(), b.lines(), same_line))
        return false;
    const Spectrum smooth_a = a.without_lines(), smooth_b = b.without_lines();
    const auto agree = [&](double nm) { return smooth_a(nm) == smooth_b(nm); };
    if (!std::ranges::all_of(a.breakpoints_nm(), agree) ||
        !std::ranges::all_of(b.breakpoints_nm(), agree))
        return false;
    for (int nm = comb_from_nm; nm <= comb_to_nm; nm += comb_step_nm)
        if (!agree(nm))
            return false;
    return true;
}

} // namespace reradiant
