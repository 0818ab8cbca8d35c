#include "host/measure/measured_sample.h"
#include "reradiant/bispectral_data.h"
#include "tests/fuzz/fuzz_input.h"

#include <cmath>

// This target reads the data of `fit`: the CSV of `measure`, and the re-radiation CSV with gaps.
// NaN stands for what was not measured; infinities stand for nothing. `colour` reads the former in
// one geometry, where every entry is there.

using namespace reradiant;

namespace {

void read_as_sample(const std::filesystem::path& file, const ViewingGeometry& geometry) {
    fuzz::read_or_refuse([&] {
        const ReradiationMatrix matrix = MeasuredSample(file).seen_in(geometry);
        if (matrix.values.rows() != matrix.emission.count ||
            matrix.values.cols() != matrix.excitation.count || !matrix.values.allFinite())
            fuzz::fail("a sample that is not whole");
    });
}

} // namespace

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
    read_as_sample(file, {});
    read_as_sample(file, {.theta_i_deg = 20.0, .theta_o_deg = 5.0, .phi_deg = 180.0});
    read_as_sample(file,
                   {.kind = ViewingGeometry::Kind::DirectionalHemispherical, .theta_i_deg = 8.0});
    return 0;
}
