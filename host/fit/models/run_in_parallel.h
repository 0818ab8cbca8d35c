#pragma once

#include <cstddef>
#include <functional>

namespace reradiant {

/// Runs work(0) to work(count - 1), which must not depend on each other, on so many threads (0:
/// all). What one throws comes out here.
void run_in_parallel(int threads, std::size_t count, const std::function<void(std::size_t)>& work);

} // namespace reradiant
