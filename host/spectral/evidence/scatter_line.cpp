#include "host/spectral/evidence/scatter_line.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

std::string_view scatter_order_name(ScatterOrder order) {
    switch (order) {
    case ScatterOrder::First:
        return "first";
    case ScatterOrder::Third:
        return "third";
    case ScatterOrder::Half:
        return "half";
    case ScatterOrder::Second:
        break;
    }
    return "second";
}

double scatter_ratio(ScatterOrder order) {
    switch (order) {
    case ScatterOrder::First:
        return 1.0;
    case ScatterOrder::Third:
        return 3.0;
    case ScatterOrder::Half:
        return 0.5;
    case ScatterOrder::Second:
        break;
    }
    return 2.0;
}

bool on_diagonal(const WavelengthGrid& emission, int o, const WavelengthGrid& excitation, int i) {
    return std::abs(emission.centre_nm(o) - excitation.centre_nm(i)) <=
           1e-6 * std::min(emission.step_nm, excitation.step_nm);
}

Eigen::MatrixXd entries_on(const ScatterLine& line, const WavelengthGrid& emission,
                           const WavelengthGrid& excitation) {
    const double ratio = scatter_ratio(line.order);
    const double reach = line.half_width_nm + (0.5 - 1e-6) * emission.step_nm;
    Eigen::MatrixXd on(emission.count, excitation.count);
    for (int i = 0; i < excitation.count; ++i)
        for (int o = 0; o < emission.count; ++o)
            on(o, i) =
                !on_diagonal(emission, o, excitation, i) &&
                        std::abs(emission.centre_nm(o) - ratio * excitation.centre_nm(i)) < reach
                    ? 1.0
                    : 0.0;
    return on;
}

} // namespace reradiant
