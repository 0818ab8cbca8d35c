#pragma once

#include "host/fit/dye/dye_fit.h"
#include "host/fit/dye/dye_problem.h"
#include "host/fit/dye/result/dye_errors.h"

#include <Eigen/Core>

#include <chrono>
#include <memory>
#include <vector>

namespace reradiant {

/// A model at its minimum.
struct DyeCandidate {
    std::unique_ptr<DyeModel> model;
    Eigen::VectorXd packed, unseen; ///< unseen: standard errors of what is taken as dark, else 0
    SolveTrace trace;
    DyeEvidence evidence;
};

/// One fit: its data, and the steps from a first guess to the number of dyes.
class DyeSearch {
public:
    DyeSearch(const std::vector<BispectralData>& data, const DyeFitSettings& settings);

    const PreparedDyes& prepared() const { return prepared_; }
    bool noise_is_estimated() const { return is_estimated_; }
    double seconds() const;

    /// The number of dyes that is asked for, or as many as lower the criterion.
    DyeCandidate best(std::vector<DyeEvidence>& evidence);

private:
    DyeCandidate fitted(int dyes);
    void minimise(DyeCandidate& candidate, int most_iterations);
    void minimise(DyeCandidate& candidate);
    bool reaches_beyond_tables(const DyeCandidate& candidate) const;
    void hold_yields_at_one(DyeCandidate& candidate);
    void hold_what_is_unseen(DyeCandidate& candidate, DyeSpectrum which);
    void judge(DyeCandidate& candidate) const;

    const DyeFitSettings& settings_;
    std::chrono::steady_clock::time_point begin_;
    PreparedDyes prepared_;
    bool is_estimated_ = false;
};

} // namespace reradiant
