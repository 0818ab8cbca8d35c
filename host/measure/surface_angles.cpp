#include "host/measure/surface_angles.h"

#include "host/layers/stack/quadrature.h"

#include <cmath>

namespace reradiant {

std::vector<StackValues> values_at(const LayerStack& stack, const WavelengthGrid& bands) {
    std::vector<StackValues> values;
    for (const double nm : bands.centres_nm())
        values.push_back(stack_at(stack, nm));
    return values;
}

std::vector<double> breaks_in_air(const StackValues& stack) {
    std::vector<double> inner;
    for (const LayerValues& layer : stack)
        inner.push_back(std::sqrt(std::fabs((layer.ior - 1.0) * (layer.ior + 1.0))));
    return breaks_between_0_and_1(inner);
}

kernels::Vec3 direction_at(double cos_theta, double phi) {
    const double s = std::sqrt((1.0 - cos_theta) * (1.0 + cos_theta));
    return kernels::vec3(s * std::cos(phi), s * std::sin(phi), cos_theta);
}

} // namespace reradiant
