#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace reradiant {

/// FNV-1a, 64 bit, of the bytes of numbers: shows that a file was damaged, not that it was forged.
inline std::uint64_t checksum_of(const std::vector<double>& numbers) {
    std::uint64_t hash = 1469598103934665603ULL;
    const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
    for (std::size_t i = 0; i < numbers.size() * sizeof(double); ++i)
        hash = (hash ^ bytes[i]) * 1099511628211ULL;
    return hash;
}

} // namespace reradiant
