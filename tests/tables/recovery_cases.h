#pragma once

#include "reradiant/reradiation.h"
#include "reradiant/synth.h"

namespace reradiant {

/// The layers on the sample of a recovery case; Bare has none.
enum class RecoveryStack { Bare, Smooth, Rough, Absorbing };
inline constexpr RecoveryStack recovery_stacks[] = {RecoveryStack::Bare, RecoveryStack::Smooth,
                                                    RecoveryStack::Rough, RecoveryStack::Absorbing};
const char* recovery_stack_name(RecoveryStack stack);

struct RecoveryCase {
    RecoveryStack stack = RecoveryStack::Bare;
    double step_nm = 10.0;       ///< 10: 41 x 49 bands, 5: 81 x 97
    int fluorophores = 1;        ///< 1 to 4
    double noise_of_peak = 0.01; ///< read noise
};

/// Dyes whose bands overlap, over a pale substrate that reflects what they leave. Layered cases are
/// measured in two geometries.
SynthRecipe recovery_recipe(const RecoveryCase& wanted);

/// The distance of a fitted matrix from the truth, over the entries with emission > excitation.
struct RecoveryError {
    /// Root mean square error, in units of the truth's peak; `guessed`: of excitation bands under a
    /// stack whose reflectance no emission band measures, which their interreflections need. What
    /// they scale by no data can tell.
    double rmse_of_peak = 0.0, guessed_rmse_of_peak = 0.0;
    /// Share of the entries of at least 1 % of the peak whose truth lies within value +- 1.96
    /// sigma.
    double coverage = 0.0;
    /// Photons emitted over photons absorbed (1 - diagonal), over all excitation bands that have a
    /// diagonal: relative error.
    double quantum_yield = 0.0;
};
RecoveryError recovery_error(const ReradiationMatrix& truth, const ReradiationMatrix& fitted,
                             const Eigen::MatrixXd& sigma, bool was_covered);

} // namespace reradiant
