#pragma once

#include "host/spectral/colour/colour_report.h"
#include "host/spectral/colour/lamp.h"
#include "reradiant/reradiation.h"

namespace reradiant {

/// How many matrices are drawn.
inline constexpr int drawn_matrices = 1000;

/// Sets the intervals of a report on a matrix whose entries have this covariance, from
/// colour_report with the same lamp, sum and observer: by linearisation, and from matrices drawn
/// from a normal distribution (the same ones for one seed). Where entries that the lamp's light
/// reaches have an error that is not known, a warning says so. std::invalid_argument as
/// require_covariance_of.
void set_intervals(ColourReport& report, const ReradiationMatrix& matrix,
                   const MatrixCovariance& covariance, const Lamp& lamp, ColourSum sum,
                   unsigned seed);

/// What `colour --json` writes of intervals.
nlohmann::ordered_json intervals_json(const ColourIntervals& intervals);

} // namespace reradiant
