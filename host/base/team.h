#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace reradiant {

/// Work that the leader hands out: `count` items from `first` on. None: there is no more.
struct TeamTask {
    std::uint64_t first = 0, count = 0;
};

/// A member's word about its last task, none when it asks for its first one.
struct TeamReport {
    TeamTask done;
    double seconds = 0.0;
    bool interrupted = false; ///< somebody wants it all to end
    bool leaves = false;      ///< takes no more tasks
};

/// Processes that do one job together, on one machine or many; rank 0 leads. Every member calls the
/// same functions in the same order.
class Team {
public:
    virtual ~Team() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    virtual int size_on_host() const = 0; ///< members that share this member's machine
    virtual int rank_on_host() const = 0;
    bool leads() const { return rank() == 0; }

    /// Calls `work` with tasks until `next` has none for this member. `next` is called at the
    /// leader alone, for one report at a time, and not in the thread that works. A member that does
    /// not take part is given none; the leader does.
    virtual void share_tasks(const std::function<TeamTask(const TeamReport&)>& next,
                             const std::function<TeamReport(const TeamTask&)>& work,
                             bool takes_part = true) = 0;
    /// The leader's values become the sums of all members'.
    virtual void add_at_leader(std::span<double> values) = 0;
    /// The leader's value, for everybody.
    virtual std::uint64_t from_leader(std::uint64_t value) = 0;
    /// The texts of all, by rank, at the leader; empty elsewhere.
    virtual std::vector<std::string> gather(const std::string& text) = 0;
};

} // namespace reradiant
