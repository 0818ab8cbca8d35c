#include "host/layers/walk/walk_estimate.h"

#include "reradiant/error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace reradiant {

namespace {

/// Blocks are summed in groups, and the groups in pairs, in an order that does not depend on the
/// threads.
constexpr std::size_t groups = 16;
constexpr std::uint64_t blocks_in_group = walk_blocks / groups;
/// Seconds of walking between two pauses: short enough to answer interrupts, and long enough that
/// waiting for the last thread costs little.
constexpr double seconds_at_a_time = 0.25;

/// Calls f(to, from) for every array of two tallies of the same shape, as lists of numbers.
template <typename Function>
void for_pairs(WalkTally& to, const WalkTally& from, const Function& f) {
    std::vector<Eigen::Map<const Eigen::ArrayXd>> sources;
    for_arrays(from, [&](const auto& array) { sources.emplace_back(array.data(), array.size()); });
    auto source = sources.begin();
    for_arrays(to, [&](auto& array) {
        Eigen::Map<Eigen::ArrayXd> numbers(array.data(), array.size());
        f(numbers, *source++);
    });
}

/// A group of successive blocks: the sums of their totals and of the squares of these, and the
/// block in progress.
struct BlockGroup {
    WalkTally sum, squares, block;

    void end_block() {
        for_pairs(sum, block, [](auto& to, const auto& from) { to += from; });
        for_pairs(squares, block, [](auto& to, const auto& from) { to += from.square(); });
        block.set_zero();
    }
    void add(const BlockGroup& other) {
        for_pairs(sum, other.sum, [](auto& to, const auto& from) { to += from; });
        for_pairs(squares, other.squares, [](auto& to, const auto& from) { to += from; });
    }
};

/// A `WalkRun` advances all groups in step.
class WalkRun {
public:
    WalkRun(const LayerWalk& walk, const kernels::Vec3& wi, std::span<const kernels::Vec3> wo,
            std::uint64_t block_size, std::uint64_t seed)
        : walk_(walk), wi_(wi), wo_(wo), block_size_(block_size), seed_(seed) {
        const WalkTally zero = walk.tally(wo.size());
        groups_.fill({zero, zero, zero});
    }

    bool is_done() const { return blocks_ == blocks_in_group; }

    /// Runs `walks` walks in every group, but not beyond the end of the block.
    void advance(std::uint64_t walks) {
        const std::uint64_t end = std::min(block_size_, walks_ + walks);
        tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t g) {
            const std::uint64_t first = (g * blocks_in_group + blocks_) * block_size_;
            for (std::uint64_t k = walks_; k < end; ++k)
                walk_.eval(wi_, wo_, seed_, first + k, groups_[g].block);
            if (end == block_size_)
                groups_[g].end_block();
        });
        walks_ = end % block_size_;
        blocks_ += end == block_size_ ? 1 : 0;
    }

    WalkState state() const {
        WalkState state{blocks_, walks_, {}};
        for (const BlockGroup& group : groups_) {
            for (const WalkTally* tally : {&group.sum, &group.squares, &group.block}) {
                for_arrays(*tally, [&](const auto& array) {
                    state.numbers.insert(state.numbers.end(), array.data(),
                                         array.data() + array.size());
                });
            }
        }
        return state;
    }

    void restore(const WalkState& state) {
        if (state.numbers.size() != this->state().numbers.size() ||
            state.blocks > blocks_in_group || state.walks >= block_size_)
            throw_runtime_error("the walk to go on from is another one");
        const double* next = state.numbers.data();
        for (BlockGroup& group : groups_) {
            for (WalkTally* tally : {&group.sum, &group.squares, &group.block}) {
                for_arrays(*tally, [&](auto& array) {
                    std::copy_n(next, array.size(), array.data());
                    next += array.size();
                });
            }
        }
        blocks_ = state.blocks;
        walks_ = state.walks;
    }

    /// Returns the sum over all groups, which are added pair by pair.
    BlockGroup total() {
        for (std::size_t apart = 1; apart < groups; apart *= 2)
            for (std::size_t g = 0; g < groups; g += 2 * apart)
                groups_[g].add(groups_[g + apart]);
        return std::move(groups_[0]);
    }

private:
    const LayerWalk& walk_;
    kernels::Vec3 wi_;
    std::span<const kernels::Vec3> wo_;
    std::uint64_t block_size_, seed_;
    std::uint64_t blocks_ = 0, walks_ = 0;
    std::array<BlockGroup, groups> groups_;
};

void walk_to_the_end(WalkRun& run, StopFlag stop, const WalkPause& pause) {
    using Clock = std::chrono::steady_clock;
    for (std::uint64_t walks = 1; !run.is_done();) {
        throw_if_stopped(stop);
        const Clock::time_point start = Clock::now();
        run.advance(walks);
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        if (seconds < 0.5 * seconds_at_a_time)
            walks *= 2;
        else if (seconds > 2.0 * seconds_at_a_time)
            walks = std::max<std::uint64_t>(1, walks / 2);
        if (pause)
            pause(run.is_done(), [&] { return run.state(); });
    }
}

} // namespace

WalkEstimate estimate_walk(const LayerWalk& walk, const kernels::Vec3& wi,
                           std::span<const kernels::Vec3> wo, std::uint64_t samples,
                           std::uint64_t seed, StopFlag stop, const WalkState& from,
                           const WalkPause& pause) {
    const std::uint64_t size =
        std::max((samples + walk_blocks - 1) / walk_blocks, std::uint64_t{1});
    WalkRun run(walk, wi, wo, size, seed);
    if (!from.numbers.empty())
        run.restore(from);
    walk_to_the_end(run, stop, pause);
    const BlockGroup sums = run.total();
    const double blocks = static_cast<double>(walk_blocks);
    const double count = blocks * static_cast<double>(size);
    WalkEstimate result{sums.sum, sums.squares};
    for_pairs(result.standard_error, sums.sum, [&](auto& squares, const auto& sum) {
        // of equal blocks the difference may round below zero
        squares =
            ((squares - sum.square() / blocks).max(0.0) * (blocks / (blocks - 1.0))).sqrt() / count;
    });
    for_arrays(result.mean, [&](auto& mean) { mean /= count; });
    return result;
}

} // namespace reradiant
