#include "host/spectral/spectrum/spectrum_formats.h"

#include "host/spectral/files/matrix_formats.h"
#include "host/spectral/text/text_reader.h"
#include "host/spectral/text/wavelength_unit.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>

namespace reradiant {

namespace {

/// A labelled data record: ##LABEL= VALUE.
struct Record {
    TextToken label, value;
};

/// Labels are compared without case, blanks, '-', '/' and '_'.
std::string plain_label(std::string_view label) {
    std::string plain;
    for (const char c : label)
        if (std::string_view(" -/_\t").find(c) == std::string_view::npos)
            plain += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return plain;
}

/// These characters stand between the words of a unit; a minus is none of them, for it may take
/// from 1.
constexpr std::string_view between_words = " \t_()[],";

std::string upper_case(std::string_view text) {
    std::string upper(text);
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return upper;
}

std::string_view without_remark(std::string_view line) {
    return trimmed(line.substr(0, std::min(line.find("$$"), line.size())));
}

class JcampReader {
public:
    explicit JcampReader(const std::filesystem::path& file) : reader_(file, TextFormat::JcampDx) {
        table_.file = reader_.name();
        table_.columns.resize(2);
        table_.unit = UnitSource::Stated;
    }

    NumberTable read() {
        bool has_ended = false;
        while (reader_.next_line(whole_)) {
            // Texts may go on over several lines; what is no record is the rest of one.
            const std::string_view line = without_remark(whole_);
            if (!line.starts_with("##"))
                continue;
            const Record record = record_of(line);
            if (has_ended)
                fail(record.label, "a second block follows", "give a file of one spectrum");
            const std::string label = plain_label(record.label.text);
            if (label == "END")
                has_ended = true;
            else if (label == "XYDATA" || label == "XYPOINTS")
                read_data(record);
            else if (label == "PEAKTABLE" || label == "PEAKASSIGNMENTS" || label == "NTUPLES" ||
                     label == "RADATA")
                fail(record.label, fmt::format("{} is no spectrum that is read here", label),
                     "give XYDATA or XYPOINTS");
            else
                keep(label, record);
        }
        if (table_.places.empty())
            throw_input_error(reader_.end_position(), "no ##XYDATA or ##XYPOINTS",
                              "give a file of one spectrum");
        if (!has_ended)
            throw_input_error(reader_.end_position(), "##END= is missing: the file is cut off",
                              "copy it again");
        return sorted_table(std::move(table_));
    }

private:
    [[noreturn]] void fail(const TextToken& at, const std::string& what,
                           const std::string& remedy) const {
        throw_input_error(reader_.position(at), what, remedy);
    }

    /// A piece of the current line.
    TextToken token(std::string_view text) const {
        return {text, reader_.line_number(), static_cast<int>(text.data() - whole_.data()) + 1};
    }

    Record record_of(std::string_view line) const {
        const auto equals = line.find('=');
        if (equals == std::string_view::npos)
            fail(token(line), "a label without '='", "records are ##LABEL= value");
        std::string_view label = trimmed(line.substr(2, equals - 2));
        std::string_view value = trimmed(line.substr(equals + 1));
        // An empty piece has its place too.
        return {token(label.empty() ? line.substr(2, 0) : label),
                token(value.empty() ? line.substr(equals + 1, 0) : value)};
    }

    void keep(const std::string& label, const Record& record) {
        for (const char* needed :
             {"XUNITS", "YUNITS", "XFACTOR", "YFACTOR", "FIRSTX", "LASTX", "NPOINTS", "DELTAX",
              "FIRSTY", "MAXY", "MINY", "TITLE", "BLOCKS"})
            if (label == needed && !records_.emplace(label, record).second)
                fail(record.label, fmt::format("##{} is given twice", label),
                     "give a file of one spectrum");
    }

    const Record* find(const std::string& label) const {
        const auto found = records_.find(label);
        return found == records_.end() ? nullptr : &found->second;
    }

    const Record& required(const std::string& label) const {
        if (const Record* record = find(label))
            return *record;
        throw_input_error(reader_.position(reader_.line_number(), 1),
                          fmt::format("##{}= is missing before the data", label),
                          "give a whole JCAMP-DX file");
    }

    double number_or(const std::string& label, double otherwise) const {
        const Record* record = find(label);
        return record == nullptr ? otherwise : reader_.number(record->value);
    }

    WavelengthUnit x_unit() const {
        const Record& record = required("XUNITS");
        const auto unit = stated_wavelength_unit(record.value.text);
        if (!unit)
            fail(record.value, fmt::format("XUNITS are {}", record.value.text),
                 "NANOMETERS, MICROMETERS and 1/CM are read");
        return *unit;
    }

    /// 1, or 100 for percent. Words that are not known may make another quantity of it, as those
    /// of "1-TRANSMITTANCE" and "SQRT REFLECTANCE" do.
    double y_divisor() const {
        const Record& record = required("YUNITS");
        constexpr std::array<std::string_view, 20> known{"REFLECTANCE",
                                                         "TRANSMITTANCE",
                                                         "TRANSMISSION",
                                                         "PERCENT",
                                                         "PER",
                                                         "CENT",
                                                         "PCT",
                                                         "%",
                                                         "TOTAL",
                                                         "DIFFUSE",
                                                         "SPECTRAL",
                                                         "HEMISPHERICAL",
                                                         "DIRECTIONAL",
                                                         "SPECULAR",
                                                         "RELATIVE",
                                                         "FACTOR",
                                                         "TRANSMITTANCES",
                                                         "REFLECTANCES",
                                                         "FRACTION",
                                                         "ABSOLUTE"};
        bool is_fraction = false;
        std::string words = upper_case(record.value.text);
        for (std::size_t from = words.find_first_not_of(between_words);
             from != std::string::npos;) {
            const auto to = std::min(words.find_first_of(between_words, from), words.size());
            const std::string word = words.substr(from, to - from);
            if (std::find(known.begin(), known.end(), word) == known.end())
                refuse_y_units(record);
            is_fraction = is_fraction || word.starts_with("REFLECT") || word.starts_with("TRANSM");
            from = words.find_first_not_of(between_words, to);
        }
        if (!is_fraction)
            refuse_y_units(record);
        return states_percent(record.value.text) ? 100.0 : 1.0;
    }

    [[noreturn]] void refuse_y_units(const Record& record) const {
        fail(record.value, fmt::format("YUNITS are {}", record.value.text),
             "REFLECTANCE and TRANSMITTANCE are read; convert the values");
    }

    void read_data(const Record& record) {
        if (!table_.places.empty())
            fail(record.label, "a second spectrum", "give a file of one spectrum");
        const std::string form = plain_label(record.value.text);
        unit_ = x_unit();
        y_factor_ = number_or("YFACTOR", 1.0);
        y_divisor_ = y_divisor();
        x_factor_ = number_or("XFACTOR", 1.0);
        if (form == "(X++(Y..Y))")
            read_ordinates();
        else if (form == "(XY..XY)")
            read_pairs();
        else
            fail(record.value, fmt::format("the form '{}' is not read", record.value.text),
                 "(X++(Y..Y)) and (XY..XY) are");
        require_told_values(record);
    }

    /// Numbers of a line of AFFN. The compressed forms (ASDF) pack digits into letters and signs.
    std::vector<TextToken> affn(std::string_view line) const {
        constexpr std::string_view separators = " \t,;";
        std::vector<TextToken> numbers;
        for (auto from = line.find_first_not_of(separators); from != std::string_view::npos;) {
            const auto to = std::min(line.find_first_of(separators, from), line.size());
            numbers.push_back(token(line.substr(from, to - from)));
            if (const std::string_view text = numbers.back().text; text == "?")
                fail(numbers.back(), "'?' says that a value is missing", "give the value");
            else if (!is_number(text))
                fail(numbers.back(),
                     fmt::format("'{}' is no plain number: compressed forms of JCAMP-DX (PAC, SQZ, "
                                 "DIF, DUP) are not read",
                                 text.substr(0, 20)),
                     "export it as AFFN, or as CSV");
            from = line.find_first_not_of(separators, to);
        }
        return numbers;
    }

    /// Calls visit(numbers) with those of every line up to the next record, which ends the data.
    template <typename Visit>
    void each_line(const Visit& visit) {
        for (std::string_view next; reader_.peek_line(next);) {
            if (trimmed(next).starts_with("##"))
                return;
            reader_.next_line(whole_);
            if (const auto numbers = affn(without_remark(whole_)); !numbers.empty())
                visit(numbers);
        }
    }

    void add(double x, const TextToken& y, const TextToken& place) {
        const double nm = x > 0.0 ? unit_.to_nm(x) : 0.0;
        if (!(nm > 0.0 && nm <= 1e6))
            fail(place, fmt::format("{} {} is not a wavelength of light", x, unit_.name),
                 "check XUNITS, XFACTOR and FIRSTX");
        const double value = reader_.number(y) * y_factor_ / y_divisor_;
        if (!(std::abs(value) <= 1e30))
            fail(y, "the value is too large", "check YFACTOR");
        table_.columns[0].push_back(nm);
        table_.columns[1].push_back(value);
        table_.places.push_back({place.line, place.column});
    }

    void read_pairs() {
        each_line([&](const std::vector<TextToken>& numbers) {
            if (numbers.size() % 2 != 0)
                fail(numbers.back(), "an X without its Y", "write pairs X, Y");
            for (std::size_t k = 0; k < numbers.size(); k += 2)
                add(reader_.number(numbers[k]) * x_factor_, numbers[k + 1], numbers[k]);
        });
        if (find("NPOINTS"))
            require_count(point_count());
    }

    std::size_t point_count() const {
        const Record& record = required("NPOINTS");
        const double count = reader_.number(record.value);
        if (!(count >= 1.0 && count <= 1e7 && count == std::floor(count)))
            fail(record.value, fmt::format("NPOINTS is {}", record.value.text),
                 "it counts the values");
        return static_cast<std::size_t>(count);
    }

    void require_count(std::size_t count) const {
        if (table_.places.size() != count)
            throw_input_error(
                reader_.position(reader_.line_number(), 1),
                fmt::format("{} values where NPOINTS says {}", table_.places.size(), count),
                "give the whole file");
    }

    /// Equidistant abscissae: the first of every line repeats what the count of values says.
    void read_ordinates() {
        const std::size_t count = point_count();
        const double first = reader_.number(required("FIRSTX").value),
                     last = reader_.number(required("LASTX").value);
        const double step = count > 1 ? (last - first) / static_cast<double>(count - 1) : 0.0;
        if (const Record* delta = find("DELTAX"))
            if (const double given = reader_.number(delta->value);
                count > 1 && !(std::abs(std::abs(given) - std::abs(step)) <= 0.01 * std::abs(step)))
                fail(delta->value,
                     fmt::format("DELTAX is {}, but FIRSTX, LASTX and NPOINTS give {:.6g}", given,
                                 step),
                     "one of the four is wrong");
        each_line([&](const std::vector<TextToken>& numbers) {
            if (numbers.size() < 2)
                fail(numbers[0], "an X without values", "write X and its Y values");
            const auto at = [&](std::size_t k) { return first + static_cast<double>(k) * step; };
            const double expected = at(table_.places.size()),
                         given = reader_.number(numbers[0]) * x_factor_;
            if (!(std::abs(given - expected) <= 0.5 * std::abs(step) + 1e-6 * std::abs(expected)))
                fail(numbers[0], fmt::format("X is {:.8g} where {:.8g} is due", given, expected),
                     "values are missing or too many before this line, or XFACTOR is wrong");
            for (std::size_t k = 1; k < numbers.size() && table_.places.size() <= count; ++k)
                add(at(table_.places.size()), numbers[k], numbers[k]);
        });
        require_count(count);
    }

    /// FIRSTY, MAXY and MINY are there to tell that factors were applied rightly.
    void require_told_values(const Record& data) const {
        const std::vector<double>& values = table_.columns[1];
        if (values.empty())
            return;
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        require_told("FIRSTY", "first", values.front(), data);
        require_told("MAXY", "largest", *most, data);
        require_told("MINY", "least", *least, data);
    }

    /// Values were rounded to whole YFACTORs where one is given, the label's to its last digit.
    void require_told(const char* label, const char* which, double value,
                      const Record& data) const {
        const Record* record = find(label);
        if (record == nullptr)
            return;
        const double told = reader_.number(record->value), read = value * y_divisor_;
        const double step = find("YFACTOR") && y_factor_ != 1.0 ? std::abs(y_factor_) : 0.0;
        const double rounding = std::min(half_last_digit(record->value.text), std::abs(told));
        if (!(std::abs(told - read) <=
              0.02 * std::max(std::abs(told), std::abs(read)) + 1e-9 + step + rounding))
            fail(record->value,
                 fmt::format("{} is {:.6g}, but the {} value of the data at line {} times YFACTOR "
                             "is {:.6g}",
                             label, told, which, data.label.line, read),
                 "one of the two is wrong");
    }

    TextReader reader_;
    std::string_view whole_; ///< the current line
    std::map<std::string, Record> records_;
    UnsortedTable table_;
    WavelengthUnit unit_;
    double x_factor_ = 1.0, y_factor_ = 1.0, y_divisor_ = 1.0;
};

} // namespace

NumberTable read_jcamp(const std::filesystem::path& file) {
    return JcampReader(file).read();
}

} // namespace reradiant
