#pragma once

#include "host/spectral/evidence/scatter_contrast.h"
#include "reradiant/bispectral_data.h"
#include "reradiant/fit.h"

namespace reradiant {

/// Returns what some rules mask of data. Lines are looked for in every block; what stands out of
/// one is masked in all. A line that the rules name has the width that they say. There is a warning
/// for a rule that no measured entry lies on. Input Error when nothing is left off the diagonal.
FitMask mask_of(const BispectralData& data, const MaskRules& rules, const ScatterSettings& scatter);

/// The data with masked entries as gaps: NaN in value and error, in every block.
BispectralData with_gaps(BispectralData data, const FitMask& mask);

} // namespace reradiant
