#include "reradiant/colour_of_matrix.h"

namespace reradiant {

Whiteness cie_whiteness(const Xyz& xyz, const Xyz& white, Observer observer) {
    const auto chromaticity = [](const Xyz& v) {
        const double sum = v[0] + v[1] + v[2];
        return std::array{v[0] / sum, v[1] / sum};
    };
    const std::array<double, 2> colour = chromaticity(xyz), neutral = chromaticity(white);
    const double x = neutral[0] - colour[0], y = neutral[1] - colour[1];
    Whiteness result;
    result.whiteness = xyz[1] + 800.0 * x + 1700.0 * y;
    result.tint = (is_10_degree(observer) ? 900.0 : 1000.0) * x - 650.0 * y;
    result.within_limits = result.whiteness > 40.0 && result.whiteness < 5.0 * xyz[1] - 280.0 &&
                           result.tint > -4.0 && result.tint < 2.0;
    return result;
}

} // namespace reradiant
