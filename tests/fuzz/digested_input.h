#pragma once

#include "host/scene/model/sha256.h"
#include "tests/fuzz/fuzz_input.h"

namespace reradiant::fuzz {

/// Reads an input as it is, and again with the SHA-256 that its last 64 letters are made right:
/// that keeps a fuzzer out of all that it covers.
template <typename Read>
void read_digested(const std::uint8_t* bytes, std::size_t size, const Read& read) {
    constexpr std::size_t digest_letters = 64;
    const std::string_view text = text_of(bytes, size);
    read(text);
    if (size <= digest_letters)
        return;
    const std::string body(text.substr(0, size - digest_letters));
    Sha256 digest;
    digest.update(body);
    read(body + digest.hex());
}

} // namespace reradiant::fuzz
