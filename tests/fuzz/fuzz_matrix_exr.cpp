#include "tests/fuzz/check_matrix.h"

// Bispectral EXR files of one pixel.

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    reradiant::fuzz::read_as_matrix("input.exr", bytes, size);
    return 0;
}
