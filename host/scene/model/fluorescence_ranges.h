#pragma once

#include "reradiant/scene.h"

#include <array>

namespace reradiant {

/// Wavelengths that excite what fluoresces, and those that it emits, in nm; {0, 0} where there are
/// none.
struct FluorescenceRanges {
    std::array<double, 2> excitation{}, emission{};

    bool is_empty() const { return excitation[1] <= 0.0; }
    /// Makes the ranges hold those of `other` too.
    void join(const FluorescenceRanges& other);
};

FluorescenceRanges fluorescence_ranges(const Substrate& substrate);
/// Of the light that the dye absorbs, what lies below some of its emission excites it. A dye that
/// absorbs nothing has no ranges.
FluorescenceRanges fluorescence_ranges(const SlabDye& dye);
FluorescenceRanges fluorescence_ranges(const LayerStack& stack);
FluorescenceRanges fluorescence_ranges(const Material& material);

/// Returns the lowest and the highest wavelength where a spectrum is not zero, to 1 nm, looked for
/// from 200 to 1200 nm; {0, 0} if it is zero everywhere.
std::array<double, 2> support_nm(const Spectrum& spectrum);

} // namespace reradiant
