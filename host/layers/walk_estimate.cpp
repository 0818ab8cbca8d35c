#include "host/layers/walk_estimate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

namespace reradiant {

namespace {

/// Calls f(to, from) for every array of two tallies of the same shape.
template <typename Function>
void for_arrays(WalkTally& to, const WalkTally& from, const Function& f) {
    const auto both = [&](WalkTally::Parts& a, const WalkTally::Parts& b) {
        f(a.diffuse, b.diffuse);
        f(a.specular, b.specular);
    };
    both(to.hemispherical, from.hemispherical);
    for (std::size_t k = 0; k < to.directional.size(); ++k) {
        both(to.directional[k], from.directional[k]);
    }
    f(to.delta, from.delta);
    f(to.lost, from.lost);
}

/// Sums of block totals and of their squares, as tbb's reductions want them.
class BlockSums {
public:
    BlockSums(const LayerWalk& walk, const kernels::Vec3& wi, std::span<const kernels::Vec3> wo,
              std::uint64_t block_size, std::uint64_t seed, StopFlag stop)
        : walk_(walk), wi_(wi), wo_(wo), block_size_(block_size), seed_(seed), stop_(stop),
          sum(walk.tally(wo.size())), squares(sum) {}
    BlockSums(const BlockSums& other, tbb::split)
        : BlockSums(other.walk_, other.wi_, other.wo_, other.block_size_, other.seed_,
                    other.stop_) {}

    void operator()(const tbb::blocked_range<std::uint64_t>& blocks) {
        WalkTally block = walk_.tally(wo_.size());
        for (std::uint64_t b = blocks.begin(); b != blocks.end(); ++b) {
            block.set_zero();
            for (std::uint64_t k = 0; k < block_size_ && !is_stopped(stop_); ++k) {
                walk_.eval(wi_, wo_, seed_, b * block_size_ + k, block);
            }
            for_arrays(sum, block, [](auto& to, const auto& from) { to += from; });
            for_arrays(squares, block, [](auto& to, const auto& from) { to += from.cwiseAbs2(); });
        }
    }
    void join(const BlockSums& other) {
        for_arrays(sum, other.sum, [](auto& to, const auto& from) { to += from; });
        for_arrays(squares, other.squares, [](auto& to, const auto& from) { to += from; });
    }

private:
    const LayerWalk& walk_;
    kernels::Vec3 wi_;
    std::span<const kernels::Vec3> wo_;
    std::uint64_t block_size_, seed_;
    StopFlag stop_;

public:
    WalkTally sum, squares;
};

} // namespace

WalkEstimate estimate_walk(const LayerWalk& walk, const kernels::Vec3& wi,
                           std::span<const kernels::Vec3> wo, std::uint64_t samples,
                           std::uint64_t seed, StopFlag stop) {
    const std::uint64_t size =
        std::max((samples + walk_blocks - 1) / walk_blocks, std::uint64_t{1});
    BlockSums sums(walk, wi, wo, size, seed, stop);
    // deterministic: ranges are split alike and joined in order, whatever the threads
    tbb::parallel_deterministic_reduce(tbb::blocked_range<std::uint64_t>(0, walk_blocks, 16), sums);
    throw_if_stopped(stop);
    const double blocks = static_cast<double>(walk_blocks);
    const double count = blocks * static_cast<double>(size);
    WalkEstimate result{sums.sum, sums.squares};
    for_arrays(result.standard_error, sums.sum, [&](auto& squares, const auto& sum) {
        // of equal blocks the difference may round below zero
        squares = ((squares - sum.cwiseAbs2() / blocks).cwiseMax(0.0) * (blocks / (blocks - 1.0)))
                      .cwiseSqrt() /
                  count;
    });
    for_arrays(result.mean, sums.sum, [&](auto& mean, const auto&) { mean /= count; });
    return result;
}

} // namespace reradiant
