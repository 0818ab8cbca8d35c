#pragma once

#include "host/fit/data/bispectral_data.h"
#include "host/fit/data/mask_rules.h"
#include "host/spectral/evidence/scatter_detection.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace reradiant {

/// Entries of measured data that a fit takes as missing, and why.
struct FitMask {
    MaskRules rules;                 ///< as applied: lines that were found stand among the others
    std::vector<FoundScatter> found; ///< those that stood out by themselves
    Eigen::MatrixXd entries;         ///< 1: masked, else 0, (emission, excitation); empty: none is
    int measured = 0;                ///< masked entries that some block measured
    std::vector<std::string> notes, warnings;

    bool any() const { return measured > 0; }
};

/// Returns what some rules mask of data. Lines are looked for in every block; what stands out of
/// one is masked in all. A line that the rules name has the width that they say. There is a warning
/// for a rule that no measured entry lies on. Input Error when nothing is left off the diagonal.
FitMask mask_of(const BispectralData& data, const MaskRules& rules, const ScatterSettings& scatter);

/// The data with masked entries as gaps: NaN in value and error, in every block.
BispectralData with_gaps(BispectralData data, const FitMask& mask);

} // namespace reradiant
