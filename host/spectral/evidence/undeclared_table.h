#pragma once

#include "reradiant/error.h"
#include "reradiant/spectral_files.h"

#include <optional>
#include <string>

namespace reradiant {

/// A table of numbers that does not say its quantity or its orientation.
struct UndeclaredTable {
    std::string file;
    std::optional<MatrixQuantity> quantity;
    std::optional<bool> rows_are_emission;
    TableForm told;           ///< what was said besides the file
    bool is_scaled = false;   ///< its scale is known
    bool is_measured = false; ///< its kind is known
    bool needs_decimal = false;
    bool has_gaps = false, has_percent_signs = false;
    /// The numbers as per-band with rows = emission; empty where they cannot be read.
    std::optional<ReradiationMatrix> as_rows_emission = {};
};

/// Input Error that says what the values speak for, and how it is declared: by the command or by
/// the lines to add. What nothing speaks for is named as a choice.
[[noreturn]] void refuse_undeclared_table(const UndeclaredTable& table, const SourcePosition& at);

} // namespace reradiant
