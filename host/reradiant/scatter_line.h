#pragma once

#include <array>
#include <string>
#include <string_view>

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

} // namespace reradiant
