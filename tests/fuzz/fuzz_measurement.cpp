#include "reradiant/bispectral_data.h"
#include "tests/fuzz/fuzz_input.h"

#include <cmath>

// This target reads the data of `fit`: the CSV of `measure`, and the re-radiation CSV with gaps.
// NaN stands for what was not measured; infinities stand for nothing.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const auto file = fuzz::put("input.csv", fuzz::text_of(bytes, size));
    fuzz::read_or_refuse([&] {
        const BispectralData data = read_bispectral_data(file);
        if (data.blocks.empty() || data.measured_count() < 1)
            fuzz::fail("data without a measured entry");
        for (const BispectralBlock& block : data.blocks) {
            if (block.value.rows() != data.emission.count ||
                block.value.cols() != data.excitation.count)
                fuzz::fail("a block of another size than the grids");
            for (const double value : block.value.reshaped())
                if (std::isinf(value))
                    fuzz::fail("an infinite entry");
        }
    });
    return 0;
}
