#include "host/spectral/text/table_head.h"

#include "host/spectral/text/head_key.h"
#include "host/spectral/text/text_reader.h"
#include "host/spectral/text/words.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace reradiant {

namespace {

constexpr std::string_view blanks = " \t\r\f\v";

/// Pieces between any of the separators that no quotation marks enclose.
std::vector<std::string> pieces_of(std::string_view text, std::string_view separators) {
    std::vector<std::string> pieces(1);
    bool is_quoted = false;
    for (const char c : text)
        if (c == '"')
            is_quoted = !is_quoted;
        else if (!is_quoted && separators.find(c) != std::string_view::npos)
            pieces.emplace_back();
        else
            pieces.back() += c;
    for (std::string& piece : pieces)
        piece = std::string(trimmed(piece));
    return pieces;
}

std::vector<std::string> words_between_blanks(std::string_view text) {
    auto words = pieces_of(text, blanks);
    std::erase(words, "");
    return words;
}

/// Joins the words of a heading without separators to columns: a unit in brackets, behind a stroke
/// or "in" belongs to the word before it, and where words are left over the last column has them.
std::vector<std::string> columns_of_words(std::string_view text, std::size_t column_count) {
    std::vector<std::string> columns;
    bool continues = false;
    for (const std::string& word : words_between_blanks(text)) {
        const bool joins = continues || word.find_first_of("([/") == 0 || word == "in";
        continues = word == "/" || word == "in";
        if (joins && !columns.empty())
            columns.back().append(" ").append(word);
        else
            columns.push_back(word);
    }
    const auto join_next = [&](std::size_t k) {
        columns[k].append(" ").append(columns[k + 1]);
        columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    };
    // "Optical frequency (THz)  R" and "Wavelength nm  Total R": the axis ends at its unit.
    for (std::size_t k = 1; k < columns.size() && columns.size() > column_count && k < 3; ++k) {
        std::string axis = columns[0];
        for (std::size_t i = 1; i <= k; ++i)
            axis.append(" ").append(columns[i]);
        if (stated_wavelength_unit(columns[0]) || !stated_wavelength_unit(axis))
            continue;
        for (std::size_t i = 0; i < k; ++i)
            join_next(0);
        break;
    }
    if (!columns.empty() && names_wavelengths(columns[0]))
        while (columns.size() > column_count && column_count > 1)
            join_next(column_count - 1);
    return columns;
}

bool has_separator(std::string_view line) {
    return line.find_first_of(",;\t") != std::string_view::npos;
}

/// Headings of the columns of a line. The separator is that of the rows where the line has it.
std::vector<std::string> headings_of(std::string_view line, std::string_view first_row,
                                     std::size_t column_count) {
    for (const char separator : {';', ',', '\t'}) {
        const std::string_view own(&separator, 1);
        if (first_row.find(separator) == std::string_view::npos)
            continue;
        if (auto pieces = pieces_of(line, own); pieces.size() > 1)
            return pieces;
    }
    for (const char* separator : {";", ",", "\t"})
        if (auto pieces = pieces_of(line, separator); pieces.size() > 1)
            return pieces;
    std::string text(line);
    if (text.starts_with('"') && text.find_first_of('"', 1) == text.size() - 1)
        return headings_of(text.substr(1, text.size() - 2), first_row, column_count);
    return columns_of_words(line, column_count);
}

/// True for a cell that is a unit and nothing else, as in a line of units below the names.
bool is_unit_cell(const std::string& cell) {
    const std::string small = lower_case(cell);
    constexpr std::array<std::string_view, 9> units{"",    "%",      "-",       "1", "a.u.",
                                                    "rel", "counts", "percent", "au"};
    const bool is_bracketed =
        !cell.empty() && std::string_view("([").find(cell.front()) != std::string_view::npos;
    return is_bracketed || is_one_of(units, small) || small.find("w/") != std::string::npos;
}

class HeadReader {
public:
    HeadReader(const std::vector<HeadLine>& head, std::string_view first_row,
               std::size_t column_count, const std::string& file)
        : head_(head), first_row_(first_row), column_count_(column_count), file_(file) {
        units_.divisors.assign(column_count, 1.0);
    }

    ColumnUnits read() {
        bool names_columns = false;
        const HeadLine* last = nullptr; // the line next to the rows
        for (const HeadLine& line : head_) {
            if (read_key_value(line))
                continue;
            if (says_values_are_percent(line.text))
                std::fill(units_.divisors.begin() + 1, units_.divisors.end(), 100.0);
            last = &line;
            const auto headings = headings_of(line.text, first_row_, column_count_);
            if (headings.size() < column_count_ || !may_name_columns(line, headings))
                continue;
            names_columns = names_columns || names_wavelengths(headings[0]);
            named_.push_back({&line, headings});
        }
        std::erase_if(named_, [&](const Named& named) {
            return names_columns && !names_wavelengths(named.headings[0]);
        });
        for (const Named& named : named_)
            if (names_columns)
                take(named, &named == &named_.back());
        if (!names_columns && !named_.empty())
            take_unnamed(named_.back());
        else if (!names_columns && last != nullptr)
            take_remark(*last);
        require_one_scale();
        return units_;
    }

private:
    struct Named {
        const HeadLine* line;
        std::vector<std::string> headings;
    };

    [[noreturn]] void fail(const HeadLine& line, const std::string& what,
                           const std::string& remedy) const {
        throw_input_error({file_, line.line, 1}, what, remedy);
    }

    /// A comment names columns where it has as many words, or states the unit of wavelength; a
    /// letter alone may be a lamp's name. "Serial,7" is no heading.
    bool may_name_columns(const HeadLine& line, const std::vector<std::string>& headings) const {
        if (headings.size() > 1 && begins_as_number(headings[1]) &&
            (is_number(headings[1]) ||
             !(begins_with_axis_name(headings[0]) || headings[0] == "nm")))
            return false; // "nm,1-R" is one
        if (!line.is_comment)
            return true;
        const bool is_letter = headings[0] == "A" || headings[0] == "m";
        return headings.size() == column_count_ && !is_letter && names_wavelengths(headings[0]);
    }

    bool read_key_value(const HeadLine& line) {
        const KeyValue found = key_value_of(line.text);
        switch (found.kind) {
        case KeyValue::Kind::None:
            return false;
        case KeyValue::Kind::Factor:
            if (found.value != "1" && found.value != "1.0")
                fail(line, "the line states a factor that is not applied here",
                     "multiply the values by it and leave the line out");
            return true;
        case KeyValue::Kind::XUnits:
            read_wavelength_unit(line, found.value);
            return true;
        case KeyValue::Kind::YUnits:
            read_scale(line, found.value);
            return true;
        case KeyValue::Kind::Units:
            if (const auto unit = stated_wavelength_unit(found.value))
                tell(line, *unit);
            else
                require_axis(line, found.value);
            if (!stated_wavelength_unit(found.value) || states_percent(found.value))
                read_scale(line, found.value);
            return true;
        }
        return false;
    }

    void read_wavelength_unit(const HeadLine& line, const std::string& text) {
        const auto unit = stated_wavelength_unit(text);
        if (!unit)
            fail(line, fmt::format("the unit of wavelength '{}' is not known here", text),
                 "nm, um, A and 1/cm are read");
        tell(line, *unit);
    }

    /// A scale for all the columns of values.
    void read_scale(const HeadLine& line, const std::string& text) {
        require_quantity(line, text);
        if (states_percent(text)) {
            std::fill(units_.divisors.begin() + 1, units_.divisors.end(), 100.0);
        } else if (text == "1" || text.starts_with("1 ") || text.starts_with("1;") ||
                   text.starts_with("1,") || lower_case(text) == "fraction") {
            fraction_ = &line;
        } else if (begins_as_number(text) || lower_case(text).starts_with("x ")) {
            fail(line, fmt::format("the unit '{}' is not known here", text),
                 "give values of unit 1, or in percent");
        }
    }

    void require_one_scale() const {
        const bool has_percent = std::any_of(units_.divisors.begin(), units_.divisors.end(),
                                             [](double divisor) { return divisor == 100.0; });
        if (fraction_ != nullptr && has_percent)
            fail(*fraction_,
                 "the line says that values are fractions, another that they are percent",
                 "say one of the two");
    }

    void require_quantity(const HeadLine& line, const std::string& text) const {
        if (const std::string quantity = stated_other_quantity(text); !quantity.empty())
            fail(line, fmt::format("'{}' is no reflectance and no light", quantity),
                 "convert the values to unit 1 or percent, and say so in the heading");
    }

    void require_axis(const HeadLine& line, const std::string& text) const {
        if (const std::string axis = stated_other_axis(text); !axis.empty())
            fail(line, fmt::format("'{}' is not a wavelength", axis),
                 "the first column holds wavelengths, in nm unless its heading names another unit");
    }

    void tell(const HeadLine& line, const WavelengthUnit& unit) {
        if (units_.source == UnitSource::Stated && units_.wavelength.name != unit.name)
            fail(line,
                 fmt::format("wavelengths are in {} here, but in {} in another line", unit.name,
                             units_.wavelength.name),
                 "say one of the two");
        units_.wavelength = unit;
        units_.source = UnitSource::Stated;
    }

    /// Above the line next to the rows, "A,test" and "Path length (mm),x" are no names of columns.
    void take(const Named& named, bool is_last) {
        const std::string& axis = named.headings[0];
        const bool is_unit_line =
            std::all_of(named.headings.begin() + 1, named.headings.end(), is_unit_cell);
        if (!is_last && !is_unit_line && !begins_with_axis_name(axis))
            return;
        if (const auto unit = stated_wavelength_unit(axis))
            tell(*named.line, *unit);
        else
            require_known_brackets(*named.line, axis);
        take_values(named);
    }

    void take_unnamed(const Named& named) {
        require_axis(*named.line, named.headings[0]);
        take_values(named);
    }

    /// "# Frequency in THz" above rows that nothing else names.
    void take_remark(const HeadLine& line) {
        const auto headings = headings_of(line.text, first_row_, column_count_);
        if (headings.size() == column_count_ && !begins_as_number(headings[1]) &&
            has_separator(first_row_) == has_separator(line.text)) {
            require_axis(line, headings[0]);
            require_quantity(line, headings[1]);
        }
        const auto unit = stated_wavelength_unit(line.text);
        const std::string text = lower_case(line.text);
        // "Slit in mm" is of no axis.
        const bool names_axis = begins_with_axis_name(text) ||
                                text.find("frequency") != std::string::npos ||
                                text.find("energy") != std::string::npos ||
                                text.find("wavelength") != std::string::npos;
        if (unit && (names_axis || text.find_first_of(blanks) == std::string::npos))
            tell(line, *unit);
    }

    void take_values(const Named& named) {
        for (std::size_t column = 1; column < column_count_; ++column) {
            require_quantity(*named.line, named.headings[column]);
            if (states_percent(named.headings[column]))
                units_.divisors[column] = 100.0;
        }
    }

    /// "Wavelength (inch)" names a unit that is not known.
    void require_known_brackets(const HeadLine& line, std::string_view axis) const {
        const auto open = axis.find_first_of("([");
        if (open == std::string_view::npos)
            return;
        const std::string unit =
            lower_case(axis.substr(open + 1, axis.find_first_of(")]", open) - open - 1));
        constexpr std::array<std::string_view, 5> media{"air", "vacuum", "vac", "x", ""};
        const bool is_word = std::all_of(unit.begin(), unit.end(),
                                         [](unsigned char c) { return std::isalpha(c) != 0; });
        if (is_word && !is_one_of(media, unit))
            fail(line, fmt::format("the unit of wavelength '{}' is not known here", unit),
                 "nm, um, A and 1/cm are read");
    }

    const std::vector<HeadLine>& head_;
    std::string_view first_row_;
    std::size_t column_count_;
    const std::string& file_;
    std::vector<Named> named_;
    ColumnUnits units_;
    const HeadLine* fraction_ = nullptr;
};

} // namespace

ColumnUnits column_units(const std::vector<HeadLine>& head, std::string_view first_row,
                         std::size_t column_count, const std::string& file) {
    return HeadReader(head, first_row, column_count, file).read();
}

} // namespace reradiant
