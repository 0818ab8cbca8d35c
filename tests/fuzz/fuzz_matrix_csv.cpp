#include "tests/fuzz/check_matrix.h"

// The re-radiation CSV, wide and long form.

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    reradiant::fuzz::read_as_matrix("input.csv", bytes, size);
    return 0;
}
