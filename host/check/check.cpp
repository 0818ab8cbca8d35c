#include "host/check/check.h"

#include "host/check/checked_function.h"
#include "host/check/error_statistics.h"
#include "host/check/probe_source.h"
#include "host/device/buffer.h"
#include "host/device/opencl_device.h"
#include "reradiant/error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <numeric>

namespace reradiant {

namespace {

using Clock = std::chrono::steady_clock;

/// Evaluations at a time: what they read and write stays below 16 MB.
constexpr std::size_t block_items = std::size_t{1} << 17U;
/// Hard and random inputs each that a regression file keeps.
constexpr std::size_t kept_items = 200;
/// In a double program errors are smaller by 2^-29, and the twin has as large ones.
constexpr double double_precision = 1e-6;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A function's kernel in one precision, with its buffers.
template <typename Real>
class Probe {
public:
    Probe(const Device& device, const cl::Program& program, std::size_t index,
          const CheckedFunction& function, const DeviceArray<CheckTables>& tables)
        : device_(device), outputs_(function.outputs),
          kernel_(program, fmt::format("check_{}", index).c_str(), 16),
          in_(device, block_items * width_of(function.arguments)),
          out_(device, block_items * function.outputs), tables_(tables) {}

    /// Results of the block's items; keeps the shortest time an item.
    std::span<const Real> run(std::span<const float> inputs, std::size_t items) {
        device_.opencl().queue.enqueueWriteBuffer(in_.buffer(), CL_TRUE, 0, inputs.size_bytes(),
                                                  inputs.data());
        if (results_.empty()) // drivers finish compiling at the first launch
            launch(1);
        const Clock::time_point start = Clock::now();
        launch(items);
        nanoseconds_ =
            std::min(nanoseconds_, 1e9 * seconds_since(start) / static_cast<double>(items));
        results_.resize(items * outputs_);
        device_.opencl().queue.enqueueReadBuffer(out_.buffer(), CL_TRUE, 0,
                                                 results_.size() * sizeof(Real), results_.data());
        return results_;
    }
    double nanoseconds() const { return nanoseconds_; }

private:
    void launch(std::size_t items) {
        kernel_.bind(in_.buffer(), out_.buffer(), static_cast<cl_uint>(items), tables_.buffer());
        kernel_.launch(device_, items);
        device_.opencl().queue.finish();
    }

    const Device& device_;
    std::size_t outputs_;
    Kernel kernel_;
    DeviceArray<float> in_;
    DeviceArray<Real> out_;
    const DeviceArray<CheckTables>& tables_;
    std::vector<Real> results_;
    double nanoseconds_ = std::numeric_limits<double>::infinity();
};

/// A `CheckRun` holds what all functions of a run share.
struct CheckRun {
    const Device& device;
    const CheckOptions& options;
    CheckTables tables = check_tables();
    DeviceArray<CheckTables> device_tables{device, std::span<const CheckTables>(&tables, 1)};
    BuildStatistics build = {};
};

template <typename Real>
std::vector<ItemError> errors_of(const CheckRun& run, const CheckedFunction& function,
                                 std::span<const float> inputs, std::span<const Real> results) {
    const std::size_t width = width_of(function.arguments), outputs = function.outputs;
    std::vector<ItemError> errors(results.size() / outputs);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, errors.size(), 1024), [&](const auto& r) {
        for (std::size_t i = r.begin(); i != r.end(); ++i)
            errors[i] = item_error<Real>(function, run.tables, inputs.subspan(i * width, width),
                                         results.subspan(i * outputs, outputs));
    });
    return errors;
}

/// Keeps the first hard and the first random inputs' results for a regression file.
void keep_sample(const CheckedFunction& function, std::size_t hard, std::size_t first,
                 std::span<const float> results, std::span<const ItemError> errors,
                 CheckSample& sample) {
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const std::size_t item = first + i;
        if (item >= kept_items && (item < hard || item >= hard + kept_items))
            continue;
        for (std::size_t k = 0; k < function.outputs; ++k) {
            sample.results.push_back(results[i * function.outputs + k]);
            sample.budgets.push_back(errors[i].skipped ? std::numeric_limits<float>::infinity()
                                                       : errors[i].budgets[k]);
        }
    }
}

/// Adds what the function costs in double, and how far its results there are from the twin's.
void add_double(FunctionReport& report, std::span<const ItemError> errors, double nanoseconds) {
    report.double_nanoseconds = nanoseconds;
    for (const ItemError& error : errors)
        if (!error.skipped && !error.open && error.of_budget < double_precision)
            report.double_max_relative = std::max(report.double_max_relative, error.relative);
}

class FunctionCheck {
public:
    FunctionCheck(CheckRun& run, const CheckedFunction& function, const cl::Program& program,
                  const cl::Program* in_double, std::size_t index)
        : run_(run), function_(function), inputs_(function.name, function.arguments),
          probe_(run.device, program, index, function, run.device_tables) {
        if (in_double)
            double_probe_ = std::make_unique<Probe<double>>(run.device, *in_double, index, function,
                                                            run.device_tables);
        report_.name = function.name;
        report_.header = function.header;
        report_.reason = function.accuracy.reason;
        report_.allowed_relative = function.accuracy.relative;
        report_.inputs = inputs_.hard_count() + run.options.samples;
    }

    FunctionReport run() {
        const std::size_t hard = inputs_.hard_count();
        run_block(0, hard); // fewer than a block
        for (std::size_t first = hard; first < report_.inputs; first += block_items)
            run_block(first, std::min(block_items, report_.inputs - first));
        report_.nanoseconds = probe_.nanoseconds();
        statistics_.judge(function_, report_);
        return std::move(report_);
    }

private:
    void run_block(std::size_t first, std::size_t items) {
        std::vector<float> inputs(items * inputs_.width());
        inputs_.fill(first, inputs);
        const std::span<const float> results = probe_.run(inputs, items);
        const std::vector<ItemError> errors = errors_of(run_, function_, inputs, results);
        statistics_.add(errors, first < inputs_.hard_count());
        keep_sample(function_, inputs_.hard_count(), first, results, errors, report_.sample);
        if (double_probe_)
            add_double(report_,
                       errors_of(run_, function_, inputs, double_probe_->run(inputs, items)),
                       double_probe_->nanoseconds());
    }

    CheckRun& run_;
    const CheckedFunction& function_;
    InputSequence inputs_;
    Probe<float> probe_;
    std::unique_ptr<Probe<double>> double_probe_;
    ErrorStatistics statistics_;
    FunctionReport report_;
};

/// Functions that are asked for, those of one header next to each other.
std::vector<CheckedFunction> chosen_functions(const std::string& only) {
    std::vector<CheckedFunction> functions = checked_functions();
    std::erase_if(functions, [&](const CheckedFunction& function) {
        return function.name.find(only) == std::string::npos;
    });
    if (functions.empty())
        throw_input_error({"--only"}, fmt::format("no device function has '{}' in its name", only),
                          "take a part of a name that `check` lists, such as fresnel");
    std::stable_sort(functions.begin(), functions.end(),
                     [](const auto& a, const auto& b) { return a.header < b.header; });
    return functions;
}

void check_header(CheckRun& run, std::span<const CheckedFunction> functions, CheckReport& report,
                  const std::function<void(const FunctionReport&)>& progress) {
    const std::string& header = functions.front().header;
    const std::string source = probe_source(functions);
    const cl::Program program = build_program_from_text(run.device, "check of " + header, source,
                                                        probe_defines(header, false), &run.build);
    const bool in_double = run.options.in_double && !functions.front().single_only;
    cl::Program double_program;
    if (in_double)
        double_program = build_program_from_text(run.device, "check of " + header + " in double",
                                                 source, probe_defines(header, true), &run.build);
    for (std::size_t i = 0; i < functions.size(); ++i) {
        FunctionCheck check(run, functions[i], program, in_double ? &double_program : nullptr, i);
        report.functions.push_back(check.run());
        if (progress)
            progress(report.functions.back());
    }
}

} // namespace

bool CheckReport::passed() const {
    return std::all_of(functions.begin(), functions.end(),
                       [](const FunctionReport& function) { return function.passed(); });
}

CheckReport check_device(const Device& device, const CheckOptions& options,
                         const std::function<void(const FunctionReport&)>& progress) {
    const Clock::time_point start = Clock::now();
    if (options.in_double)
        check_double(device.info());
    const std::vector<CheckedFunction> functions = chosen_functions(options.only);
    CheckReport report;
    opencl_checked("checking", [&] {
        CheckRun run{device, options};
        for (auto first = functions.begin(); first != functions.end();) {
            const auto end = std::find_if(first, functions.end(), [&](const auto& function) {
                return function.header != first->header;
            });
            check_header(run, {first, end}, report, progress);
            first = end;
        }
        report.build = run.build;
    });
    report.seconds = seconds_since(start);
    return report;
}

} // namespace reradiant
