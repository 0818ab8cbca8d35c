#include "host/layers/stack/directions.h"

#include "host/layers/stack/quadrature.h"

#include <cmath>

namespace reradiant {

std::vector<double> breaks_in_air(std::span<const StackElement> stack) {
    std::vector<double> inner;
    for (const StackElement& element : stack)
        if (const auto* slab = std::get_if<SlabValues>(&element))
            inner.push_back(std::sqrt(std::fabs((slab->ior - 1.0) * (slab->ior + 1.0))));
    return breaks_between_0_and_1(inner);
}

kernels::Vec3 direction_at(double cos_theta, double phi) {
    const double s = std::sqrt((1.0 - cos_theta) * (1.0 + cos_theta));
    return kernels::vec3(s * std::cos(phi), s * std::sin(phi), cos_theta);
}

} // namespace reradiant
