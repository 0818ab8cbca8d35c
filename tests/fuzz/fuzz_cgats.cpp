#include "tests/fuzz/check_spectrum.h"

// CGATS.17 and Argyll's .sp.

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    reradiant::fuzz::read_as_spectrum(bytes, size, reradiant::read_cgats);
    return 0;
}
