#pragma once

#include "reradiant/fit.h"

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace reradiant {

struct EmittedPhotons {
    Eigen::MatrixXd share; ///< (excitation bands, terms): photons emitted per incident photon
    /// Standard error of the sum over some bands of what one term emits.
    std::function<double(Eigen::Index term, const std::vector<Eigen::Index>& bands)> sigma_of_sum;
};

/// One yield a term, from the excitation bands where the term emits at least half as many photons
/// as at its best and more than the others do (all of the former if it never does). The absorbed
/// photons are 1 - diagonal, shared like the emission; all photons where the diagonal was not
/// measured. Warns where they are uncertain by more than 10 %; NaN, with a warning,
/// where 95 % of their error reach down to none.
std::vector<QuantumYield> quantum_yields(const EmittedPhotons& emitted,
                                         const Eigen::VectorXd& diagonal,
                                         const Eigen::VectorXd& diagonal_sigma,
                                         std::vector<std::string>& warnings);

} // namespace reradiant
