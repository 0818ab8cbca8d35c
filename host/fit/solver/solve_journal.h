#pragma once

#include "host/fit/solver/non_negative_solver.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <memory>
#include <mutex>
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

/// How far the minimisations of a fit have come, those of all branches together.
struct SolveProgress {
    int minimisations = 0, finished = 0, iterations = 0;
};

/// The minimisations of one fit in their order; those that may run at the same time in branches of
/// their own, which are in the order in which they were asked for. A fit takes the same steps
/// whenever it is run and by however many threads, so that one which finds its earlier run here
/// goes on where that stopped, bit for bit.
class SolveJournal {
public:
    SolveJournal() = default;
    /// Reads the journal of an earlier run. Input Error for JSON that is no journal.
    explicit SolveJournal(const nlohmann::json& json);
    /// Returns this journal and all its branches as JSON. While they run, only `after_step` may
    /// call it.
    nlohmann::json json() const;
    /// Counts what json() holds; may be called when it may.
    SolveProgress progress() const;

    /// The next minimisation, as far as the earlier run came with it, or from its start. Run-time
    /// Error when the earlier run started elsewhere.
    SolveState begin(const Eigen::VectorXd& start);
    /// Called after every step and at the end of the one that was begun last.
    void note(SolveState state);

    /// The next branch, for one thread; lives as long as the journal.
    SolveJournal& branch();

    /// Somebody who may want to keep all this: called after the steps of every branch, one call at
    /// a time.
    void set_after_step(std::function<void()> after_step);

private:
    /// `Shared` holds what all branches have in common.
    struct Shared {
        std::mutex mutex;
        std::function<void()> after_step;
    };

    SolveJournal(const nlohmann::json& json, std::shared_ptr<Shared> shared);

    std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
    std::vector<SolveState> solves_;
    std::vector<std::unique_ptr<SolveJournal>> branches_;
    std::size_t begun_ = 0, branched_ = 0;
};

} // namespace reradiant
