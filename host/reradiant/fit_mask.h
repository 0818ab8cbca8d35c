#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

/// Light of the lamp that gratings pass at a multiple of its wavelength: emission = ratio times
/// excitation with ratio 1, 2, 3 or 1/2.
enum class ScatterOrder { First, Second, Third, Half };
inline constexpr std::array scatter_orders = {ScatterOrder::First, ScatterOrder::Second,
                                              ScatterOrder::Third, ScatterOrder::Half};
/// `first`, `second`, `third` or `half`.
std::string_view scatter_order_name(ScatterOrder order);
double scatter_ratio(ScatterOrder order);

/// A line of scattered light across a matrix.
struct ScatterLine {
    ScatterOrder order = ScatterOrder::Second;
    double half_width_nm = 0.0; ///< of emission

    bool operator==(const ScatterLine&) const = default;
};

/// A line that stands out of a measured matrix.
struct FoundScatter {
    ScatterLine line;
    int entries = 0;     ///< measured ones on the line
    double height = 0.0; ///< median over excitations of what stands out, unit 1

    bool operator==(const FoundScatter&) const = default;
};

/// "second-order scatter at emission = 2 x excitation +- 5 nm, about 0.02 high (10 entries)".
std::string scatter_text(const FoundScatter& found);

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
