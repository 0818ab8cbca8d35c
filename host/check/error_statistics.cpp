#include "host/check/error_statistics.h"

#include "host/check/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace reradiant {

namespace {

using tracked::Tracked;

/// A unit in the last place of single precision at `x`, not below the smallest normal number's.
double unit_of(double x) {
    const int exponent = std::ilogb(std::max(std::fabs(x), tracked::least_normal));
    return std::ldexp(1.0, exponent - 23);
}

void add_output(ItemError& item, const Accuracy& accuracy, const Tracked& expected, double found) {
    if (!(std::fabs(expected.value) <= static_cast<double>(FLT_MAX))) {
        item.skipped = true;
        return;
    }
    item.not_finite = item.not_finite || !std::isfinite(found);
    const double error = std::fabs(found - expected.value);
    const double scale = std::max(std::fabs(expected.value), accuracy.floor);
    item.relative = std::max(item.relative, error / scale);
    item.ulp = std::max(item.ulp, error / unit_of(scale));
    if (error > 0.0)
        item.of_budget = std::max(item.of_budget, error / expected.error);
}

double not_exceeded_by(std::vector<float>& values, double share) {
    if (values.empty())
        return 0.0;
    const auto at =
        std::min(values.size() - 1,
                 static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()))));
    std::nth_element(values.begin(), values.begin() + static_cast<long>(at), values.end());
    return static_cast<double>(values[at]);
}

} // namespace

template <typename Real>
ItemError item_error(const CheckedFunction& function, const CheckTables& tables,
                     std::span<const float> inputs, std::span<const Real> results) {
    Tracked in[most_arguments], out[most_outputs];
    for (std::size_t k = 0; k < inputs.size(); ++k)
        in[k] = static_cast<double>(inputs[k]);
    tracked::undecided = false;
    function.twin(in, out, &tables);
    ItemError item;
    bool unbounded = false;
    for (std::size_t k = 0; k < function.outputs; ++k) {
        add_output(item, function.accuracy, out[k], static_cast<double>(results[k]));
        unbounded = unbounded || !std::isfinite(out[k].error);
        item.budgets[k] =
            static_cast<float>(tracked::undecided ? tracked::unbounded : out[k].error);
    }
    const bool excused = (tracked::undecided && item.of_budget > 1.0) || unbounded;
    item.open = excused && item.relative > function.accuracy.relative;
    if (excused)
        item.of_budget = 0.0; // no budget applies
    return item;
}

template ItemError item_error(const CheckedFunction&, const CheckTables&, std::span<const float>,
                              std::span<const float>);
template ItemError item_error(const CheckedFunction&, const CheckTables&, std::span<const float>,
                              std::span<const double>);

void ErrorStatistics::add(std::span<const ItemError> items, bool are_hard) {
    for (const ItemError& item : items) {
        if (item.skipped)
            continue;
        random_ += are_hard ? 0 : 1;
        not_finite_ += item.not_finite ? 1 : 0;
        open_ += item.open && !are_hard ? 1 : 0;
        if (item.not_finite || item.open)
            continue;
        if (!are_hard) {
            relative_.push_back(static_cast<float>(item.relative));
            ulp_.push_back(static_cast<float>(item.ulp));
        }
        max_relative_ = std::max(max_relative_, item.relative);
        max_ulp_ = std::max(max_ulp_, item.ulp);
        of_budget_ = std::max(of_budget_, item.of_budget);
        over_budget_ += item.of_budget > 1.0 ? 1 : 0;
    }
}

void ErrorStatistics::judge(const CheckedFunction& function, FunctionReport& report) {
    report.max_relative = max_relative_;
    report.max_ulp = max_ulp_;
    report.most_relative = not_exceeded_by(relative_, 0.999);
    report.most_ulp = not_exceeded_by(ulp_, 0.999);
    report.of_budget = of_budget_;
    report.over_budget = over_budget_;
    report.not_finite = not_finite_;
    report.open_share =
        static_cast<double>(open_) / static_cast<double>(std::max<std::size_t>(random_, 1));
    if (not_finite_ > 0)
        report.failures.push_back(fmt::format("{} results are NaN or infinite", not_finite_));
    if (over_budget_ > 0)
        report.failures.push_back(
            fmt::format("{} errors exceed what OpenCL allows, by up to {:.3g} times", over_budget_,
                        of_budget_));
    if (!(report.most_relative <= function.accuracy.relative))
        report.failures.push_back(fmt::format("99.9 % of the errors reach {:.3g}, allowed are {:g}",
                                              report.most_relative, function.accuracy.relative));
    if (report.open_share > function.accuracy.open)
        report.failures.push_back(fmt::format("{:.3g} of the results are open, allowed are {:g}",
                                              report.open_share, function.accuracy.open));
}

} // namespace reradiant
