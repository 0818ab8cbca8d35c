#pragma once

#include "host/spectral/spectrum/spectrum_formats.h"
#include "tests/fuzz/fuzz_input.h"

#include <algorithm>
#include <functional>

namespace reradiant::fuzz {

/// Checks what every reader of spectra promises: columns of one length, finite, with wavelengths
/// that ascend.
inline void check_spectrum(const NumberTable& table) {
    for (const auto& column : table.columns) {
        require_all_finite(column, "column of a spectrum");
        if (column.empty() || column.size() != table.columns[0].size())
            fail("columns of different lengths");
    }
    const auto& nm = table.columns[0];
    if (std::adjacent_find(nm.begin(), nm.end(), std::greater_equal<>()) != nm.end())
        fail("wavelengths that do not ascend");
}

/// Reads the bytes by one of the readers.
template <typename Read>
void read_as_spectrum(const std::uint8_t* bytes, std::size_t size, const Read& read) {
    const auto file = put("input.csv", text_of(bytes, size));
    read_or_refuse([&] { check_spectrum(read(file)); });
}

} // namespace reradiant::fuzz
