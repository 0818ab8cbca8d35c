#pragma once

#include "host/check/tracked.h"

#include "host/check/arguments.h"
#include "kernels/core/check_tables.h"

#include <string>
#include <vector>

namespace reradiant {

/// An `Accuracy` is what 99.9 % of a function's results must keep, whatever the device's own errors
/// are: the demand on the formula. Errors are relative to the result or to `floor`, whichever is
/// larger.
struct Accuracy {
    double relative;
    double floor;
    const char* reason;
    /// Share of results that may be anything finite since a comparison, or a number that has lost
    /// all digits, decides them.
    double open = 1e-3;
};

/// One row of the table of device functions. `body` is OpenCL C that reads in[] and tables and
/// writes out[]; `twin` is the same text compiled with tracked numbers.
struct CheckedFunction {
    std::string name;
    std::string header; ///< file below kernels/
    Arguments arguments;
    std::size_t outputs;
    Accuracy accuracy;
    std::string body;
    void (*twin)(const tracked::Tracked* in, tracked::Tracked* out, const CheckTables* tables);
    bool single_only = false; ///< has no form in double
};

/// A row whose body is the last argument: statements of the language that OpenCL C and C++ share.
#define CHECKED_FUNCTION(name, header, arguments, outputs, accuracy, ...)                          \
    CheckedFunction {                                                                              \
        name, header, arguments, outputs, accuracy, #__VA_ARGS__ ";",                              \
            []([[maybe_unused]] const tracked::Tracked* in, tracked::Tracked* out,                 \
               [[maybe_unused]] const CheckTables* tables) {                                       \
                using namespace tracked;                                                           \
                __VA_ARGS__;                                                                       \
            }                                                                                      \
    }

/// A row of a function that only OpenCL C can compile: its body there, and the same written anew.
#define CHECKED_ON_DEVICE(name, header, arguments, outputs, accuracy, body, ...)                   \
    CheckedFunction {                                                                              \
        name, header, arguments, outputs, accuracy, body,                                          \
            []([[maybe_unused]] const tracked::Tracked* in, tracked::Tracked* out,                 \
               [[maybe_unused]] const CheckTables* tables) {                                       \
                using namespace tracked;                                                           \
                __VA_ARGS__;                                                                       \
            },                                                                                     \
            true                                                                                   \
    }

std::vector<CheckedFunction> interface_functions();
std::vector<CheckedFunction> stack_functions();
std::vector<CheckedFunction> walk_functions();
std::vector<CheckedFunction> light_functions();
std::vector<CheckedFunction> texture_functions();
std::vector<CheckedFunction> lane_functions();
/// All of them.
std::vector<CheckedFunction> checked_functions();

/// The tables that the functions read.
CheckTables check_tables();

// Arguments that many functions take, with their hard values.
Argument unit();      ///< [0, 1), multiples of 2^-24 and neighbours of 1
Argument cosine();    ///< 0..1
Argument ior();       ///< ratio 0.25 .. 4
Argument alpha();     ///< roughness 1e-4 .. 1
Argument direction(); ///< upper hemisphere
Argument any_direction();
Argument between(double from, double to);
Argument integer(int count);

} // namespace reradiant
