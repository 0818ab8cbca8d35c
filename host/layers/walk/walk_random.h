#pragma once

#include <cstdint>

namespace reradiant {

/// Uniform numbers in [0, 1) of one stream of one sample. Counter-based: they depend on (seed,
/// sample, stream) and on how many came before, not on threads. SplitMix64 (Steele, Lea and Flood
/// 2014), a bijection of the counter, keyed by itself; 53 bits, so that free paths have no end at
/// the 17 mean free paths that 24 bits reach.
class WalkRandom {
public:
    WalkRandom(std::uint64_t seed, std::uint64_t sample, std::uint64_t stream)
        : key_(mix(mix(mix(seed + step) + sample) + stream)) {}

    double next() { return static_cast<double>(mix(key_ += step) >> 11U) * 0x1p-53; }

private:
    static constexpr std::uint64_t step = 0x9e3779b97f4a7c15U;

    static std::uint64_t mix(std::uint64_t z) {
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31U);
    }

    std::uint64_t key_;
};

} // namespace reradiant
