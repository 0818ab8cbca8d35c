#include "host/fit/model_selection.h"

#include <cmath>

namespace reradiant {

double information_criterion(double chi_squared, Eigen::Index parameters, Eigen::Index data,
                             Evidence evidence) {
    const double n = static_cast<double>(std::max<Eigen::Index>(1, data));
    const double misfit =
        evidence == Evidence::KnownNoise ? chi_squared : n * std::log1p(chi_squared / n);
    return misfit + static_cast<double>(parameters) * std::log(n);
}

FittedCandidate dark_candidate(const FitTarget& target, Evidence evidence) {
    FittedCandidate dark;
    dark.fit.chi_squared = target.value.cwiseProduct(target.weight).squaredNorm();
    dark.fit.trace.converged = true;
    dark.fit.trace.stop_reason = "there is nothing to fit";
    dark.criterion = information_criterion(dark.fit.chi_squared, 0, target.used_count(), evidence);
    return dark;
}

} // namespace reradiant
