#pragma once

#include "host/check/checked_function.h"

#include <array>
#include <span>
#include <vector>

namespace reradiant {

struct FunctionReport;

constexpr std::size_t most_arguments = 16, most_outputs = 8;

/// An `ItemError` is what one evaluation of a function came to, all outputs together.
struct ItemError {
    double relative = 0.0, ulp = 0.0;
    double of_budget = 0.0;                    ///< largest error over what OpenCL allows
    std::array<float, most_outputs> budgets{}; ///< absolute; infinite where a comparison decides
    bool open = false; ///< over budget, but a comparison or lost digits may excuse it
    bool not_finite = false;
    bool skipped = false; ///< the twin itself has no finite value there
};

/// Runs the twin on one item's inputs and sets it against the device's results (float or double).
template <typename Real>
ItemError item_error(const CheckedFunction& function, const CheckTables& tables,
                     std::span<const float> inputs, std::span<const Real> results);

/// The errors of many items, and what they say about a function.
class ErrorStatistics {
public:
    /// Hard items are held to the device's budget, but say nothing of what is usual.
    void add(std::span<const ItemError> items, bool are_hard);
    /// Fills the report's figures and failures.
    void judge(const CheckedFunction& function, FunctionReport& report);

private:
    std::vector<float> relative_, ulp_; ///< errors of the random items
    double max_relative_ = 0.0, max_ulp_ = 0.0, of_budget_ = 0.0;
    std::size_t open_ = 0, random_ = 0, not_finite_ = 0, over_budget_ = 0;
};

} // namespace reradiant
