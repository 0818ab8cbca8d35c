#include "host/fit/data/fit_target.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

template <typename Function>
Eigen::MatrixXd on_grid(const WavelengthGrid& emission, const WavelengthGrid& excitation,
                        Function function) {
    Eigen::MatrixXd result(emission.count, excitation.count);
    for (int i = 0; i < excitation.count; ++i)
        for (int o = 0; o < emission.count; ++o)
            result(o, i) = function(emission.centre_nm(o), excitation.centre_nm(i));
    return result;
}

} // namespace

Eigen::MatrixXd photon_weights(const WavelengthGrid& emission, const WavelengthGrid& excitation) {
    const double steps = emission.step_nm / excitation.step_nm;
    return on_grid(emission, excitation,
                   [steps](double lo, double li) { return steps * std::max(1.0, lo / li); });
}

Eigen::MatrixXd allowed_entries(const WavelengthGrid& emission, const WavelengthGrid& excitation,
                                bool anti_stokes) {
    const double same = 1e-6 * std::min(emission.step_nm, excitation.step_nm);
    return on_grid(emission, excitation, [=](double lo, double li) {
        return lo > li + same || (anti_stokes && lo < li - same) ? 1.0 : 0.0;
    });
}

} // namespace reradiant
