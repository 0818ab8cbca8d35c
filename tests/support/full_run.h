#pragma once

#include <cstdlib>

namespace reradiant::test {

/// True under `tools/test --full` (RERADIANT_FULL_TESTS is set): statistics may take minutes.
inline bool is_full_run() {
    return std::getenv("RERADIANT_FULL_TESTS") != nullptr;
}

} // namespace reradiant::test
