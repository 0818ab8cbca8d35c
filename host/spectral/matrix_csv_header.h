#pragma once

#include "host/spectral/reradiation.h"
#include "host/spectral/text_reader.h"

#include <optional>
#include <string>
#include <string_view>

namespace reradiant {

/// What the '#' lines say. Quantity and orientation are never guessed.
struct CsvHeader {
    std::optional<MatrixQuantity> quantity;
    std::optional<bool> rows_are_emission;
    std::optional<MatrixKind> kind;
    std::optional<bool> anti_stokes_allowed;
    std::optional<std::string> geometry;
    std::optional<bool> is_percent;
    std::optional<double> emission_step_nm, excitation_step_nm; ///< for an axis of one band
};

/// Takes a '#' line of a re-radiation CSV, the reader's current one. Lines that are no `key: value`
/// are remarks, and so are unknown keys. Input Error for a key that is given twice or has a value
/// that is not known.
void read_csv_header_line(const TextReader& reader, std::string_view line, CsvHeader& header);

/// Input Error unless quantity and orientation were declared.
void require_declared(const TextReader& reader, const CsvHeader& header);

} // namespace reradiant
