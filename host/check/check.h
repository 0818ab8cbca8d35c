#pragma once

#include "host/device/program.h"
#include "reradiant/device.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace reradiant {

struct CheckOptions {
    std::size_t samples = 1000000; ///< random inputs a function, besides the hard ones
    std::string only;              ///< functions with this in their name; empty: all
    bool in_double = false;        ///< also build every function in double and compare
};

/// Results of the first inputs of a function and by how much each may move, for a regression file.
struct CheckSample {
    std::vector<float> results;
    std::vector<float> budgets; ///< how much each may move; infinite where a comparison decides
};

/// A `FunctionReport` says how a function did on the device. Errors are the largest over its
/// outputs; relative ones are as the function's Accuracy says.
struct FunctionReport {
    std::string name, header, reason;
    std::size_t inputs = 0;
    double max_ulp = 0.0, most_ulp = 0.0; ///< largest, and that which 99.9 % do not exceed
    double max_relative = 0.0, most_relative = 0.0;
    double allowed_relative = 0.0; ///< limit of `most_relative`
    double of_budget = 0.0;        ///< largest error over what OpenCL allows there
    double open_share = 0.0;       ///< over it, but a comparison may decide (CheckedFunction)
    std::size_t over_budget = 0, not_finite = 0;
    double nanoseconds = 0.0; ///< an evaluation, with its reading and writing
    /// Time and error of the function in double; 0 where it was not asked for.
    double double_nanoseconds = 0.0, double_max_relative = 0.0;
    std::vector<std::string> failures; ///< why it does not pass; empty: it does
    CheckSample sample;
    bool passed() const { return failures.empty(); }
};

struct CheckReport {
    std::vector<FunctionReport> functions;
    BuildStatistics build;
    double seconds = 0.0;
    bool passed() const;
};

/// Runs the device functions on hard and random inputs, against the same source in double precision
/// with a running bound of what the OpenCL specification allows a device (tracked.h). `progress`
/// is called after each. Input Error when no function fits `only`, or when double is asked of a
/// device that has none.
CheckReport check_device(const Device& device, const CheckOptions& options,
                         const std::function<void(const FunctionReport&)>& progress = {});

/// Saves the results of this run, to be compared with later.
void save_results(const std::filesystem::path& file, const Device& device,
                  const CheckReport& report);

/// `SavedResults` holds what save_results wrote, by function.
struct SavedResults {
    std::filesystem::path file;
    std::map<std::string, CheckSample> functions;
};
/// Input Error when the file is none of save_results.
SavedResults read_saved_results(const std::filesystem::path& file);

/// Adds a failure to every function whose results moved by more than both runs' budgets since they
/// were saved, or that was not saved.
void compare_results(const SavedResults& saved, CheckReport& report);

} // namespace reradiant
