#pragma once

#include "host/fit/bispectral_data.h"
#include "host/fit/fit_target.h"
#include "host/fit/shared_errors.h"

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
    std::optional<SharedErrors> errors; ///< empty: those of the entries are independent
    std::vector<std::string> notes;

    bool is_empty() const { return target.used_count() == 0; }
};

/// Makes the target of one block without geometry: leaves out what was not measured, what spills
/// from the diagonal and saturated plateaus, and weighs by the data's standard errors or an
/// estimate of them. Negative entries stay as they are, so that noise averages out; without given
/// errors they become zero where they are too many and too large to be noise, which a note says. A
/// diagonal outside 0..1 is moved to that range, which a note says, too.
PreparedTarget prepare_target(const BispectralData& data, const TargetSettings& settings);

/// Standard error of a smooth matrix with the same noise everywhere, from the median of its mixed
/// second differences (1 -2 1) x (1 -2 1) over the places where all nine entries are `used`, or of
/// its mixed fourth differences where these see less: both vanish for what is smooth enough and
/// have 36 and 4900 times the variance of an entry. 0 when fewer than 16 places can be looked at.
double estimated_noise(const Eigen::MatrixXd& value, const Eigen::MatrixXd& used);

/// Entries on a plateau at the largest value: at least four of the same value, as a detector leaves
/// them that is full. Zero where there is none; 1 on the plateau.
Eigen::MatrixXd saturated_entries(const Eigen::MatrixXd& value);

} // namespace reradiant
