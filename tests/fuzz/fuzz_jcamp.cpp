#include "tests/fuzz/check_spectrum.h"

// JCAMP-DX in its AFFN forms.

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    reradiant::fuzz::read_as_spectrum(bytes, size, reradiant::read_jcamp);
    return 0;
}
