#pragma once

#include "host/check/checked_function.h"
#include "host/device/source.h"

#include <span>
#include <string>

namespace reradiant {

/// OpenCL C of a program that has one kernel for each of the functions (all of one header):
/// check_0(in, out, count, tables), check_1 and so on. in: [item][width of the arguments] floats;
/// out: [item][outputs] of the precision that the program is built in.
std::string probe_source(std::span<const CheckedFunction> functions);
KernelDefines probe_defines(const std::string& header, bool in_double);

} // namespace reradiant
