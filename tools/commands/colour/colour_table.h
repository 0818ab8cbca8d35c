#pragma once

#include "tools/commands/colour/seen_colours.h"

#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// A `ColourTable` holds a row for each sample, lamp and observer. Numbers are texts; what is not
/// defined is empty.
struct ColourTable {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
};

/// Tables for people have few digits, short names of samples, and no column that holds nothing.
/// This one has the colour, the indices and the differences.
ColourTable short_table(const std::vector<SeenSample>& samples, const ColourOptions& options);
/// The colour alone; without what ultraviolet light excites where `uv_excluded`.
ColourTable colour_table(const std::vector<SeenSample>& samples, const ColourOptions& options,
                         bool uv_excluded);
/// Whiteness, tint, R457 and E313. Rows of lamps for which none is defined are left out.
ColourTable index_table(const std::vector<SeenSample>& samples, const ColourOptions& options,
                        bool uv_excluded);
/// Differences from the reference.
ColourTable difference_table(const std::vector<SeenSample>& samples, const ColourOptions& options);

/// All numbers of the JSON but those per wavelength, ten digits.
ColourTable whole_table(const std::vector<SeenSample>& samples, const ColourOptions& options);

/// Text in columns, two blanks between them, numbers to the right.
std::string aligned(const ColourTable& table);

/// Writes a table as CSV (RFC 4180, lines end in LF). Atomic.
void write_csv(const std::filesystem::path& file, const ColourTable& table);

} // namespace reradiant
