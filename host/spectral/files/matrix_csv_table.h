#pragma once

#include "host/spectral/files/matrix_csv_header.h"
#include "host/spectral/files/matrix_formats.h"
#include "host/spectral/text/text_reader.h"
#include "host/spectral/text/wavelength_unit.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace reradiant {

/// Both axes and the values, rows = emission, in the file's quantity.
struct CsvBody {
    std::vector<PlacedWavelength> emission, excitation;
    Eigen::MatrixXd values;
};

/// Cells of values that have a percent sign, and the first that has none.
struct PercentSigns {
    bool some = false;
    std::optional<SourcePosition> without;
};

/// Reads the cells of a line, and what stands in them.
class CellReader {
public:
    /// Lines of '#' below the headings count too: `header` takes what they say.
    CellReader(TextReader& reader, CsvHeader& header, const WavelengthUnit& unit)
        : reader_(reader), header_(header), unit_(unit) {}

    /// Cells of the next line that has any; empty behind the last. Empty cells beyond `most` are
    /// dropped.
    std::vector<TextToken> next(std::size_t most);
    PlacedWavelength wavelength(const TextToken& cell) const;
    double value(TextToken cell);
    double value_or_gap(const TextToken& cell); ///< NaN for a gap

    const TextReader& reader() const { return reader_; }
    const PercentSigns& signs() const { return signs_; }

private:
    TextReader& reader_;
    CsvHeader& header_;
    WavelengthUnit unit_;
    PercentSigns signs_;
};

/// A wide table as it stands, with its gaps.
struct WideTable {
    struct Gap {
        Eigen::Index row, column;
        TextToken cell;
    };
    std::vector<PlacedWavelength> rows, columns;
    Eigen::MatrixXd values;
    std::vector<Gap> gaps;
};

WideTable read_wide(CellReader& cells, const std::vector<TextToken>& headings);

/// The table with its rows and columns in the order of wavelengths, rows = emission.
CsvBody sorted_body(WideTable table, bool rows_are_emission);

/// `LongColumns` says which columns of the long form hold what.
struct LongColumns {
    std::size_t excitation = 0, emission = 1, value = 2;
};

/// Returns the columns that the headings name; empty for headings of the wide form. Input Error
/// where a column of the long form lacks.
std::optional<LongColumns> long_columns(const TextReader& reader,
                                        const std::vector<TextToken>& headings);
CsvBody read_long(CellReader& cells, const LongColumns& columns, Gaps gaps);

} // namespace reradiant
