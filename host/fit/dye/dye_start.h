#pragma once

#include "host/fit/dye/dye_model.h"

namespace reradiant {

/// Returns parameters to begin with: spectra from a factorisation of the first block, which light
/// that is absorbed twice bends but does not hide, at several optical depths, of which the one that
/// is best after a few steps is taken.
DyeParameters dye_start(const DyeProblem& problem, int dyes, const SolverSettings& settings);

} // namespace reradiant
