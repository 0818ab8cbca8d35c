#pragma once

#include "host/fit/fit.h"
#include "host/fit/prepared_target.h"

namespace reradiant {

/// The data's diagonal into a result; gaps between measured bands are bridged by straight lines,
/// which a note says.
void pass_diagonal(const PreparedTarget& prepared, FitResult& result);

/// Error figures of the model against the data (INTERFACE, `--json` of fit).
void measure_errors(const PreparedTarget& prepared, FitResult& result);

/// Finite, non-negative entries and convergence, no energy at impossible places, energy and photon
/// balance, looked at with fresh eyes. Sets anti_stokes_energy, and `failure` to the first thing
/// that is wrong.
void check_fit(FitResult& result);

} // namespace reradiant
