#pragma once

#include "reradiant/spectral_files.h"
#include "tests/fuzz/fuzz_input.h"

namespace reradiant::fuzz {

/// A matrix that a reader returned is whole: as large as its grids, and finite.
inline void check_matrix(const ReradiationMatrix& matrix) {
    if (matrix.values.rows() != matrix.emission.count ||
        matrix.values.cols() != matrix.excitation.count || matrix.emission.count < 1 ||
        matrix.excitation.count < 1)
        fail("a matrix of another size than its grids");
    require_all_finite(matrix.values.reshaped(), "entry of a matrix");
    for (const WavelengthGrid& grid : {matrix.emission, matrix.excitation}) {
        require_finite(grid.from_nm, "first wavelength of a grid");
        require_finite(grid.to_nm(), "last wavelength of a grid");
        if (!(grid.step_nm > 0.0))
            fail("a grid without a step");
    }
}

/// Reads the bytes as a matrix file of this ending.
inline void read_as_matrix(const char* name, const std::uint8_t* bytes, std::size_t size) {
    const auto file = put(name, text_of(bytes, size));
    read_or_refuse([&] {
        holds_reradiation(file);
        check_matrix(read_reradiation(file));
    });
}

} // namespace reradiant::fuzz
