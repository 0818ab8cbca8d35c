#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

// This header holds the part of oneTBB that this project uses, written with the threads of the
// standard library. Builds for the thread sanitizer include it in place of oneTBB: they cannot see
// how the library, which is not built with them, hands tasks from thread to thread, and would call
// every result a race. Here the tasks of one loop are ordered by nothing but what their bodies do.

namespace tbb {

template <typename Value>
class blocked_range {
public:
    blocked_range(Value begin, Value end, std::size_t grain_size = 1)
        : begin_(begin), end_(end), grain_size_(grain_size) {}

    Value begin() const { return begin_; }
    Value end() const { return end_; }
    std::size_t size() const { return begin_ < end_ ? static_cast<std::size_t>(end_ - begin_) : 0; }
    std::size_t grainsize() const { return grain_size_; }

private:
    Value begin_, end_;
    std::size_t grain_size_;
};

/// Pieces are of the grain's size.
struct simple_partitioner {};

namespace thread_sanitizer {

/// The most threads that global_control allows; at least two, or there were nothing to see.
inline std::atomic<int> most_threads =
    std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
/// The number of threads of the arena that this thread is in; 0: most_threads. Loops inside loops
/// are serial.
inline thread_local int arena_threads = 0;

inline int concurrency() {
    const int most = most_threads;
    return arena_threads > 0 ? std::min(arena_threads, most) : most;
}

class ArenaScope {
public:
    explicit ArenaScope(int threads) { arena_threads = threads; }
    ArenaScope(const ArenaScope&) = delete;
    ArenaScope& operator=(const ArenaScope&) = delete;
    ~ArenaScope() { arena_threads = before_; }

private:
    int before_ = arena_threads;
};

/// Calls body(begin, end) for pieces of [0, count) of `piece` numbers; the first exception ends it.
template <typename Body>
void run_pieces(std::size_t count, std::size_t piece, const Body& body) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failure;
    std::mutex mutex;
    const auto work = [&] {
        const ArenaScope inner(1);
        try {
            for (std::size_t at = next.fetch_add(piece); at < count; at = next.fetch_add(piece))
                body(at, std::min(count, at + piece));
        } catch (...) {
            next = count;
            const std::scoped_lock lock(mutex);
            if (!failure)
                failure = std::current_exception();
        }
    };
    const std::size_t pieces = (count + piece - 1) / piece;
    std::vector<std::thread> others;
    for (std::size_t k = 1; k < std::min(pieces, static_cast<std::size_t>(concurrency())); ++k)
        others.emplace_back(work);
    work();
    for (std::thread& other : others)
        other.join();
    if (failure)
        std::rethrow_exception(failure);
}

template <typename Value, typename Body>
void run_range(const blocked_range<Value>& range, std::size_t piece, const Body& body) {
    run_pieces(range.size(), piece, [&](std::size_t begin, std::size_t end) {
        body(blocked_range<Value>(range.begin() + static_cast<Value>(begin),
                                  range.begin() + static_cast<Value>(end), range.grainsize()));
    });
}

} // namespace thread_sanitizer

template <typename Value, typename Body>
void parallel_for(const blocked_range<Value>& range, const Body& body, simple_partitioner) {
    thread_sanitizer::run_range(range, range.grainsize(), body);
}

template <typename Value, typename Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
    constexpr std::size_t pieces_a_thread = 4;
    const std::size_t threads = static_cast<std::size_t>(thread_sanitizer::concurrency());
    thread_sanitizer::run_range(
        range, std::max(range.grainsize(), range.size() / (pieces_a_thread * threads)), body);
}

template <typename Index, typename Body>
void parallel_for(Index first, Index last, const Body& body) {
    parallel_for(blocked_range<Index>(first, last), [&](const blocked_range<Index>& range) {
        for (Index i = range.begin(); i != range.end(); ++i)
            body(i);
    });
}

} // namespace tbb
