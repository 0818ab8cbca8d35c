#include "tests/fuzz/check_spectrum.h"

// IES TM-27 (.spdx).

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    reradiant::fuzz::read_as_spectrum(bytes, size, reradiant::read_tm27);
    return 0;
}
