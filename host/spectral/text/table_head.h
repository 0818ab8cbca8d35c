#pragma once

#include "host/spectral/text/wavelength_unit.h"

#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

/// A comment or a heading before the rows of a table; a comment has no mark at its front.
struct HeadLine {
    std::string text;
    int line = 0;
    bool is_comment = false;
};

/// `ColumnUnits` holds what the lines above a table say of its columns.
struct ColumnUnits {
    WavelengthUnit wavelength;
    UnitSource source = UnitSource::Assumed;
    std::vector<double> divisors; ///< per column: 100 for percent
};

/// Reads the units of a table's columns from its head. Units come from the line that names the
/// columns, be it a comment, from a line of units beside it, and from lines such as
/// "Y Units: Reflectance (%)"; titles say nothing. Input Error with the line for units told twice
/// and differently, for a factor, and for an axis or a quantity that is no wavelength or no linear
/// scale. `first_row` tells how cells are separated.
ColumnUnits column_units(const std::vector<HeadLine>& head, std::string_view first_row,
                         std::size_t column_count, const std::string& file);

} // namespace reradiant
