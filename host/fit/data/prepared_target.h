#pragma once

#include "host/fit/data/fit_target.h"
#include "host/fit/result/shared_errors.h"
#include "reradiant/bispectral_data.h"

#include <optional>
#include <string>
#include <vector>

namespace reradiant {

struct TargetSettings {
    bool anti_stokes = false;
    double spill_nm = 0.0; ///< entries this near to the diagonal are not used
};

/// A target and what belongs to it beside the fluorescent part.
struct PreparedTarget {
    FitTarget target;
    Eigen::VectorXd diagonal, diagonal_sigma; ///< a number per excitation band; NaN: not measured
    double noise = 0.0;                       ///< median standard error of the used entries, unit 1
    bool noise_is_estimated = false;
    Eigen::MatrixXd shared_rounding;    ///< EntryErrors
    std::optional<SharedErrors> errors; ///< empty: those of the entries are independent
    std::vector<std::string> notes;

    bool is_empty() const { return target.used_count() == 0; }
};

/// Makes the target of one block without geometry: leaves out what was not measured, what spills
/// from the diagonal and saturated plateaus, and weighs by entry_errors. Negative entries stay as
/// they are, so that noise averages out; without given errors they become zero where they are too
/// many and too large to be noise, which a note says. A diagonal outside 0..1 is moved to that
/// range, which a note says, too.
PreparedTarget prepare_target(const BispectralData& data, const TargetSettings& settings);

/// Entries on a plateau at the largest value: at least four of the same value, as a detector leaves
/// them that is full, and, in numbers that are rounded, more than on the next three levels. Zero
/// where there is none; 1 on the plateau.
Eigen::MatrixXd saturated_entries(const Eigen::MatrixXd& value);

} // namespace reradiant
