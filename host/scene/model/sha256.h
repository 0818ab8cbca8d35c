#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace reradiant {

/// SHA-256 (FIPS 180-4) of bytes that arrive in pieces.
class Sha256 {
public:
    void update(std::string_view bytes);
    /// 64 hex digits of everything so far. More may be added afterwards.
    std::string hex() const;

private:
    void add_block(const unsigned char* block);

    std::array<std::uint32_t, 8> state_{0x6a09e667u, 0xbb67ae85u, 0x3c6ef372u, 0xa54ff53au,
                                        0x510e527fu, 0x9b05688cu, 0x1f83d9abu, 0x5be0cd19u};
    std::array<unsigned char, 64> pending_{};
    std::size_t pending_count_ = 0;
    std::uint64_t byte_count_ = 0;
};

} // namespace reradiant
