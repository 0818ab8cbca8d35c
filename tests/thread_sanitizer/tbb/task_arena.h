#pragma once

#include "parallel_for.h"

namespace tbb {

class task_arena {
public:
    static constexpr int automatic = -1;

    explicit task_arena(int threads = automatic) : threads_(std::max(threads, 0)) {}

    template <typename Body>
    void execute(const Body& body) {
        const thread_sanitizer::ArenaScope scope(threads_);
        body();
    }

private:
    int threads_;
};

namespace this_task_arena {

inline int max_concurrency() {
    return thread_sanitizer::concurrency();
}

/// Nobody takes the tasks of another loop here.
template <typename Body>
void isolate(const Body& body) {
    body();
}

} // namespace this_task_arena
} // namespace tbb
