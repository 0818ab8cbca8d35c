#include "host/spectral/files/matrix_csv_header.h"

#include "host/spectral/files/matrix_formats.h"
#include "host/spectral/text/csv_lines.h"
#include "host/spectral/text/wavelength_unit.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

namespace reradiant {

namespace {

constexpr double shortest_nm = 100.0, longest_nm = 3000.0;
constexpr std::size_t fewest_bands = 3;

/// The number of a cell that may have "nm" behind it; 0 where it is none.
double number_of(const TextToken& cell) {
    std::string_view text = cell.text;
    if (text.ends_with("nm"))
        text = trimmed(text.substr(0, text.size() - 2));
    return begins_as_number(text) && is_number(text) ? number_at(text, {}) : 0.0;
}

bool is_band(const TextToken& cell) {
    const double nm = number_of(cell);
    return nm >= shortest_nm && nm <= longest_nm;
}

} // namespace

bool are_bands(const std::vector<TextToken>& cells, std::size_t from) {
    if (cells.size() < from + fewest_bands ||
        !std::all_of(cells.begin() + static_cast<long>(from), cells.end(), is_band))
        return false;
    const bool ascends = number_of(cells[from]) < number_of(cells[from + 1]);
    for (std::size_t k = from + 1; k < cells.size(); ++k)
        if ((number_of(cells[k - 1]) < number_of(cells[k])) != ascends ||
            number_of(cells[k - 1]) == number_of(cells[k]))
            return false;
    return true;
}

namespace {

/// A title may hold a number: "Sample 7" or "Integration time;0,5". It is shorter than the rows.
bool is_title(const std::vector<TextToken>& cells, const std::vector<TextToken>& next) {
    const auto numbers = std::count_if(cells.begin() + 1, cells.end(), [](const TextToken& cell) {
        return begins_as_number(cell.text) && number_of(cell) != 0.0;
    });
    const auto others = static_cast<std::ptrdiff_t>(cells.size()) - 1 - numbers;
    const bool is_short = cells.size() <= 3 && next.size() > cells.size() + 1;
    const bool is_pair_above_words = cells.size() == 2 && !next.empty() &&
                                     !begins_as_number(next[0].text) &&
                                     !names_wavelengths(cells[0].text);
    return numbers == 0 || is_short || is_pair_above_words ||
           (others > 0 && next.size() != cells.size()) || others > numbers;
}

/// Digits parted by one kind of sign: 28.06.1999, 2026-06-28, 6/28/99, 13:57.
bool is_date_or_time(std::string_view text) {
    constexpr std::string_view digits = "0123456789";
    const auto first = text.find_first_not_of(digits);
    if (first == 0 || first == std::string_view::npos ||
        std::string_view(".-/:").find(text[first]) == std::string_view::npos)
        return false;
    const std::string of_sign = std::string(digits) + text[first];
    return text.find_first_not_of(of_sign) == std::string_view::npos &&
           std::count(text.begin(), text.end(), text[first]) >= (text[first] == ':' ? 1 : 2) &&
           text.back() != text[first];
}

/// A title may begin with a date, or with the numbers of one. The table's rows are longer then.
bool is_dated_title(const std::vector<TextToken>& cells, const std::vector<TextToken>& next) {
    return is_date_or_time(cells[0].text) ||
           (cells.size() <= 3 && next.size() > fewest_bands && next.size() > cells.size() + 1);
}

} // namespace

LongRole long_role(std::string_view heading) {
    std::string name = lower_case(heading);
    for (const std::string_view unit :
         {"(nm)", "[nm]", "/nm", "_nm", " nm", "(%)", "[%]", "/%", " %"})
        if (name.ends_with(unit))
            name.erase(name.size() - unit.size());
    name.erase(std::min(name.find_last_not_of(' ') + 1, name.size()));
    std::replace(name.begin(), name.end(), '_', ' ');
    if (is_one_of(std::array{"excitation", "excitation wavelength", "exc", "ex"}, name))
        return LongRole::Excitation;
    if (is_one_of(std::array{"emission", "emission wavelength", "em"}, name))
        return LongRole::Emission;
    return is_one_of(std::array{"value", "values", "radiance factor"}, name) ? LongRole::Value
                                                                             : LongRole::None;
}

bool names_long_form(const std::vector<TextToken>& headings) {
    bool has_excitation = false, has_emission = false;
    for (const TextToken& heading : headings) {
        const std::string name = lower_case(heading.text);
        if (name == "excitation_nm" || name == "emission_nm")
            return true;
        has_excitation = has_excitation || long_role(name) == LongRole::Excitation;
        has_emission = has_emission || long_role(name) == LongRole::Emission;
    }
    return has_excitation && has_emission;
}

std::vector<TextToken> next_cells(const TextReader& reader) {
    const std::string_view rest = reader.rest();
    for (std::size_t from = 0; from < rest.size();) {
        const std::size_t to = std::min(rest.find('\n', from), rest.size());
        const std::string_view line = rest.substr(from, to - from);
        if (is_line_of_cells(line)) {
            std::vector<TextToken> cells = table_cells(reader, line);
            drop_padding(cells, 1);
            if (cells.size() > 1 || !cells[0].text.empty())
                return cells;
        }
        from = to + 1;
    }
    return {};
}

HeadingKind heading_kind(std::vector<TextToken> cells, std::vector<TextToken> next) {
    drop_padding(cells, 1);
    drop_padding(next, 1);
    if (names_long_form(cells))
        return HeadingKind::Headings;
    const bool all_numbers = std::all_of(
        cells.begin(), cells.end(), [](const TextToken& cell) { return number_of(cell) != 0.0; });
    if (all_numbers && next.size() == cells.size() + 1)
        return HeadingKind::HeadingsWithoutCorner;
    // Programs without text in their tables write 0 into the corner, as 0.0 or 0.000e+00, too.
    const bool is_zero = begins_as_number(cells[0].text) && is_number(cells[0].text) &&
                         number_at(cells[0].text, {}) == 0.0;
    if (is_zero && are_bands(cells, 1))
        return HeadingKind::Headings;
    if (begins_as_number(cells[0].text))
        return is_dated_title(cells, next) ? HeadingKind::Title : HeadingKind::Row;
    if (cells.size() == 1 && names_wavelengths(cells[0].text))
        return HeadingKind::Headings; // without columns, which is said of it
    return is_title(cells, next) ? HeadingKind::Title : HeadingKind::Headings;
}

std::optional<SourcePosition> declares_reradiation(const std::filesystem::path& file) {
    TextReader reader(file);
    std::optional<SourcePosition> mentioned;
    for (std::string_view line; reader.next_line(line);) {
        const std::string_view text = without_padding(line);
        if (text.starts_with('#') && lower_case(trimmed(text.substr(1))) == "reradiation")
            return reader.position(reader.line_number(), 1);
        if (const auto entry = header_entry(reader, line);
            entry && (entry->name == "quantity" || entry->name == "orientation")) {
            mentioned = mentioned.value_or(reader.position(entry->key));
            const std::string value = lower_case(entry->value.text);
            if (value.starts_with("rows-") || value.starts_with("per-band") ||
                value.starts_with("density-per-nm"))
                return mentioned;
        }
        if (!is_line_of_cells(line))
            continue;
        const std::vector<TextToken> cells = table_cells(reader, line), next = next_cells(reader);
        const HeadingKind kind = heading_kind(cells, next);
        if (names_long_form(cells))
            return reader.position(cells[0]);
        if (kind == HeadingKind::Row)
            return std::nullopt; // the first row of a spectrum
        if (kind == HeadingKind::Title)
            continue;
        std::vector<TextToken> headings = cells;
        drop_padding(headings, 1);
        const bool is_wide = are_bands(headings, kind == HeadingKind::Headings ? 1 : 0) &&
                             !next.empty() && is_band(next[0]);
        return mentioned || !is_wide ? mentioned : reader.position(cells[0]);
    }
    return std::nullopt;
}

} // namespace reradiant
