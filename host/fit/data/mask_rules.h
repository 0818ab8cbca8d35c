#pragma once

#include "host/spectral/evidence/scatter_line.h"

#include <string>
#include <vector>

namespace reradiant {

/// Entries whose band centres lie within both ranges, ends included.
struct MaskBox {
    double excitation_from_nm, excitation_to_nm, emission_from_nm, emission_to_nm;

    bool operator==(const MaskBox&) const = default;
};

/// `MaskRules` say which entries of measured data a fit takes as missing.
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

} // namespace reradiant
