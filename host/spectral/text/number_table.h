#pragma once

#include "host/spectral/text/wavelength_unit.h"
#include "reradiant/error.h"

#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// Columns of numbers of equal length; the first holds wavelengths in nm that ascend.
struct NumberTable {
    std::vector<std::vector<double>> columns;
};

/// An `UnsortedTable` holds the columns of a NumberTable as they were read, in any order, with the
/// place of every row.
struct UnsortedTable {
    std::string file;
    std::vector<std::vector<double>> columns; ///< the first in nm
    struct Place {
        int line, column;
    };
    std::vector<Place> places;
    UnitSource unit = UnitSource::Assumed;
};

/// Sorts by wavelength. Input Error for no row, for a wavelength that is given twice, and for
/// wavelengths none of which is from 200 to 1000 nm.
NumberTable sorted_table(UnsortedTable table);

/// Columns of numbers between commas, semicolons, tabs or blanks, after '#' or ';' comments and
/// lines of headings. No heading begins as a number does. The heading's unit of wavelength (nm, um,
/// A, 1/cm and so on) is converted to nm, a column that states percent to unit 1. Every row holds
/// exactly `column_count` numbers, in any order of wavelengths; at least one row. Input Error with
/// the place otherwise.
NumberTable read_number_table(const std::filesystem::path& file, int column_count);

} // namespace reradiant
