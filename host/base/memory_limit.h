#pragma once

#include "reradiant/error.h"

#include <cstdint>
#include <string>

namespace reradiant {

/// Returns the memory of the whole machine, in bytes.
std::uint64_t machine_memory_bytes();

/// Input Error at `position` when `work` ("the comparison") would take more memory than the limit
/// (0: 80 % of the machine's). Called before the memory is taken.
void check_memory_limit(const SourcePosition& position, const std::string& work, double bytes,
                        std::uint64_t limit_bytes, const std::string& remedy);

} // namespace reradiant
