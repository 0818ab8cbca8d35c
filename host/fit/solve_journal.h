#pragma once

#include "host/fit/non_negative_solver.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <vector>

namespace reradiant {

/// One minimisation between two steps: all that its next step depends on.
struct SolveState {
    Eigen::VectorXd start, parameters;
    SolveTrace trace;
    double damping = 0.0, damping_growth = 0.0, seconds = 0.0;
    int idle_steps = 0;
    bool is_done = false;
};

/// The minimisations of one fit in their order. A fit takes the same steps whenever it is run, so
/// that one which finds its earlier run here goes on where that stopped, bit for bit.
class SolveJournal {
public:
    SolveJournal() = default;
    /// Of an earlier run. Run-time Error for what is none.
    explicit SolveJournal(const nlohmann::json& json);
    nlohmann::json json() const;

    /// The next minimisation, as far as the earlier run came with it, or from its start. Run-time
    /// Error when the earlier run started elsewhere.
    SolveState begin(const Eigen::VectorXd& start);
    /// Called after every step and at the end of the one that was begun last.
    void note(SolveState state);

    std::function<void()> after_step; ///< somebody who may want to keep all this
    int earlier_steps() const { return earlier_steps_; }

private:
    std::vector<SolveState> solves_;
    std::size_t begun_ = 0;
    int earlier_steps_ = 0;
};

} // namespace reradiant
