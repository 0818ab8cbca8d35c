#include "reradiant/reradiation.h"
#include "tests/fuzz/fuzz_input.h"

// The CSV of `fit --covariance`.

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace reradiant;
    const auto file = fuzz::put("input.csv", fuzz::text_of(bytes, size));
    fuzz::read_or_refuse([&] {
        const MatrixCovariance covariance = read_covariance_csv(file);
        if (covariance.independent.rows() != covariance.emission.count ||
            covariance.independent.cols() != covariance.excitation.count ||
            covariance.directions.rows() != covariance.independent.size() ||
            (covariance.matrix && covariance.matrix->size() != covariance.independent.size()))
            fuzz::fail("a covariance of another size than its grids");
        if ((covariance.independent.array() < 0.0).any())
            fuzz::fail("a negative standard error");
        fuzz::require_all_finite(covariance.directions.reshaped(), "entry of a direction");
        if (covariance.matrix)
            fuzz::require_all_finite(covariance.matrix->reshaped(), "entry of the matrix");
    });
    return 0;
}
