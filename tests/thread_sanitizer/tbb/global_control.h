#pragma once

#include "parallel_for.h"

namespace tbb {

/// The number of threads for as long as it lives.
class global_control {
public:
    enum parameter { max_allowed_parallelism };

    global_control(parameter, std::size_t threads)
        : before_(thread_sanitizer::most_threads.exchange(static_cast<int>(threads))) {}
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;
    ~global_control() { thread_sanitizer::most_threads = before_; }

private:
    int before_;
};

} // namespace tbb
