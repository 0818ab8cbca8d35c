#pragma once

#include <atomic>
#include <stdexcept>

namespace reradiant {

/// Set by another thread to end long work early, with Interrupted; null: nobody will.
using StopFlag = const std::atomic<bool>*;

inline bool is_stopped(StopFlag stop) {
    return stop != nullptr && stop->load(std::memory_order_relaxed);
}

/// Work was ended by its StopFlag before it had a result.
class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted") {}
};

inline void throw_if_stopped(StopFlag stop) {
    if (is_stopped(stop))
        throw Interrupted();
}

} // namespace reradiant
