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

/// The colour and the indices as people read them, few digits; columns that hold nothing are left
/// out.
ColourTable short_table(const std::vector<SeenSample>& samples, const ColourOptions& options);

/// The same of `uv_excluded`, and the share of the lamp that is ultraviolet.
ColourTable ultraviolet_table(const std::vector<SeenSample>& samples, const ColourOptions& options);

/// All numbers of the JSON but those per wavelength, ten digits.
ColourTable whole_table(const std::vector<SeenSample>& samples, const ColourOptions& options);

/// Text in columns, two blanks between them, numbers to the right.
std::string aligned(const ColourTable& table);

/// Writes a table as CSV (RFC 4180, lines end in LF). Atomic.
void write_csv(const std::filesystem::path& file, const ColourTable& table);

} // namespace reradiant
