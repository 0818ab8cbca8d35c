#pragma once

#include "host/spectral/text/decimal_comma.h"
#include "host/spectral/text/text_format.h"
#include "reradiant/error.h"

#include <algorithm>
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

/// A text file in memory, line by line, the same under any locale. Lines end with LF, CR LF or CR
/// alone; a byte order mark and a control-Z at the end are skipped.
class TextReader {
public:
    /// Opens a file. Input Error when it cannot be read, is no text (see read_text_file), or says
    /// that it is of another format than the one that is read here. Decimal commas of tables become
    /// points where nothing else can be meant, or where `decimal` says that they are such.
    explicit TextReader(const std::filesystem::path& file, TextFormat expected = TextFormat::Table,
                        DecimalMark decimal = DecimalMark::Automatic);

    /// Next line without its end; false after the last.
    bool next_line(std::string_view& line);
    /// The line that next_line will give.
    bool peek_line(std::string_view& line) const;
    /// All that follows the current line.
    std::string_view rest() const {
        return std::string_view(content_).substr(std::min(next_, content_.size()));
    }
    int line_number() const { return line_; }
    SourcePosition position(const TextToken& token) const;
    SourcePosition position(int line, int column) const { return {name_, line, column}; }
    /// Returns the place for what is wrong with the file as a whole: its last line.
    SourcePosition end_position() const { return {name_, line_ > 0 ? line_ : 1, 1}; }
    const std::string& name() const { return name_; }
    /// Returns what would tell whether commas in numbers are decimal marks; empty where it is
    /// clear.
    const std::string& decimal_doubt() const { return decimal_doubt_; }

    /// Cells of the current line, blanks and quotation marks around them removed; an empty cell is
    /// kept. The separator is the semicolon where the line has one, else the comma, else the tab.
    std::vector<TextToken> split_cells(std::string_view line) const;
    /// Pieces between any run of blanks, commas and semicolons; a quoted piece may hold them.
    std::vector<TextToken> split_at_blanks(std::string_view line) const;
    /// A finite number of magnitude at most 1e30 (single precision must hold products of two);
    /// input Error with the token's place otherwise, which says so where a value is missing.
    double number(const TextToken& token) const;
    /// A wavelength: a number above 0 and at most 1e6 nm, perhaps with "nm" behind it.
    double wavelength_nm(const TextToken& token) const;

private:
    std::string name_;
    std::string content_;
    std::string decimal_doubt_; ///< what would tell decimal commas from others
    std::size_t next_ = 0;
    int line_ = 0;
};

/// TextReader::number and TextReader::wavelength_nm for a text at a place. `comma_remedy` is for a
/// text with a comma in it.
double number_at(std::string_view text, const SourcePosition& at,
                 const std::string& comma_remedy = {});
double wavelength_nm_at(std::string_view text, const SourcePosition& at,
                        const std::string& comma_remedy = {});

std::string_view trimmed(std::string_view text);
/// True when the text is one number and nothing else.
bool is_number(std::string_view text);
/// True when the text begins as a number does: a digit, or one behind a sign or a point. No heading
/// begins so.
bool begins_as_number(std::string_view text);
/// True for what programs write where nothing was measured: an empty cell, `nan`, `NA`, `--`,
/// `null` and so on, in any case.
bool is_gap(std::string_view text);

} // namespace reradiant
