#pragma once

#include "reradiant/scatter_line.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace reradiant {

/// Entries whose band centres lie within both ranges, ends included.
struct MaskBox {
    double excitation_from_nm, excitation_to_nm, emission_from_nm, emission_to_nm;

    bool operator==(const MaskBox&) const = default;
};

/// Which entries of measured data a fit takes as missing.
struct MaskRules {
    bool automatic = true; ///< lines of scatter that stand out
    std::vector<ScatterLine> lines;
    std::vector<MaskBox> boxes;

    bool operator==(const MaskRules&) const = default;
};

/// Reads `none`, or a list between commas of `auto`, `first:NM`, `second:NM`, `third:NM`, `half:NM`
/// (half widths of lines of scatter) and `box:FROM-TOxFROM-TO` (nm of excitation x emission). Input
/// Error for anything else, for an order that is named twice and for ranges that are empty.
MaskRules mask_rules_from_text(const std::string& text);

/// Returns rules in the form that mask_rules_from_text reads; reading it gives the same rules.
std::string mask_rules_text(const MaskRules& rules);

/// Entries of measured data that a fit takes as missing, and why.
struct FitMask {
    MaskRules rules;                 ///< as applied: lines that were found stand among the others
    std::vector<FoundScatter> found; ///< those that stood out by themselves
    Eigen::MatrixXd entries;         ///< 1: masked, else 0, (emission, excitation); empty: none is
    int measured = 0;                ///< masked entries that some block measured
    std::vector<std::string> notes, warnings;

    bool any() const { return measured > 0; }
};

} // namespace reradiant
