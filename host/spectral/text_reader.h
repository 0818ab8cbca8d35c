#pragma once

#include "host/error.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

/// A piece of a line, with its place.
struct TextToken {
    std::string_view text;
    int line = 0;
    int column = 0;
};

/// A text file in memory, line by line, the same under any locale. Lines end with LF or CR LF; a
/// byte order mark is skipped. Input Error when it cannot be read or is over 64 MiB.
class TextReader {
public:
    explicit TextReader(const std::filesystem::path& file);

    /// Next line without its end; false after the last.
    bool next_line(std::string_view& line);
    int line_number() const { return line_; }
    SourcePosition position(const TextToken& token) const;
    SourcePosition position(int line, int column) const { return {name_, line, column}; }
    const std::string& name() const { return name_; }

    /// Pieces of the current line between commas, blanks trimmed; an empty piece is kept.
    std::vector<TextToken> split_at_commas(std::string_view line) const;
    /// Pieces between any run of blanks, commas and semicolons.
    std::vector<TextToken> split_at_blanks(std::string_view line) const;
    /// A finite number of magnitude at most 1e30 (single precision must hold products of two);
    /// input Error with the token's place otherwise.
    double number(const TextToken& token) const;
    /// A wavelength: a number above 0 and at most 1e6 nm.
    double wavelength_nm(const TextToken& token) const;

private:
    std::string name_;
    std::string content_;
    std::size_t next_ = 0;
    int line_ = 0;
};

std::string_view trimmed(std::string_view text);
/// True when the text is one number and nothing else.
bool is_number(std::string_view text);

/// Columns of numbers after optional '#' comments and one optional line of headings.
struct NumberTable {
    std::vector<std::vector<double>> columns;
    std::vector<TextToken> first_column_places; ///< `text` is empty
};
/// Every row must hold exactly `column_count` numbers; at least one row, and a strictly ascending
/// first column of wavelengths. Input Error with the place otherwise.
NumberTable read_number_table(const std::filesystem::path& file, int column_count);

} // namespace reradiant
