#include "tests/fuzz/check_matrix.h"

// Matrix files of the Labsphere BFC-450.

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    reradiant::fuzz::read_as_matrix("input.bfc", bytes, size);
    return 0;
}
