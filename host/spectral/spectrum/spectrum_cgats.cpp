#include "host/spectral/spectrum/spectrum_formats.h"
#include "host/spectral/text/text_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <optional>

namespace reradiant {

namespace {

std::string upper_case(std::string_view text) {
    std::string upper(text);
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return upper;
}

/// Wavelength of a field such as SPECTRAL_NM400, SPECTRAL_NM_400, SPECTRAL_400, SPEC_400, NM400,
/// NM_400 and R_400, perhaps with NM behind it; 0 for any other field. Input Error for such a field
/// whose number is none.
double field_wavelength_nm(const std::string& name, const SourcePosition& at) {
    for (const char* prefix :
         {"SPECTRAL_NM_", "SPECTRAL_NM", "SPECTRAL_", "SPEC_", "NM_", "NM", "R_"}) {
        if (!name.starts_with(prefix))
            continue;
        std::string rest = name.substr(std::string_view(prefix).size());
        if (!begins_as_number(rest))
            continue;
        if (rest.ends_with("NM"))
            rest.resize(rest.size() - 2);
        return wavelength_nm_at(rest, at);
    }
    return 0.0;
}

/// A `Field` says what a column of the data holds.
struct Field {
    enum class Kind { Other, Value, Wavelength, Decimal, Percent } kind = Kind::Other;
    double nm = 0.0; ///< of Kind::Value
};

Field field_of(const std::string& name, const SourcePosition& at) {
    if (const double nm = field_wavelength_nm(name, at); nm > 0.0)
        return {Field::Kind::Value, nm};
    if (name == "SPECTRAL_NM")
        return {Field::Kind::Wavelength};
    if (name == "SPECTRAL_DEC")
        return {Field::Kind::Decimal};
    if (name == "SPECTRAL_PCT")
        return {Field::Kind::Percent};
    return {};
}

class CgatsReader {
public:
    explicit CgatsReader(const std::filesystem::path& file) : reader_(file, TextFormat::Cgats) {
        table_.file = reader_.name();
        table_.columns.resize(2);
        table_.unit = UnitSource::Stated;
    }

    NumberTable read() {
        for (std::string_view line; reader_.next_line(line);) {
            const auto tokens = tokens_of(line);
            if (tokens.empty())
                continue;
            const std::string key = upper_case(tokens[0].text);
            if (key == "BEGIN_DATA_FORMAT")
                read_fields();
            else if (key == "BEGIN_DATA")
                read_data(tokens[0]);
            else if (key == "SPECTRAL_NORM" && tokens.size() > 1)
                read_norm(tokens[1]);
            else if (key == "NUMBER_OF_SETS" && tokens.size() > 1)
                sets_ = reader_.number(tokens[1]);
        }
        if (values_.empty())
            throw_input_error(reader_.end_position(), "no data",
                              "its table begins with BEGIN_DATA");
        assign();
        return sorted_table(std::move(table_));
    }

private:
    [[noreturn]] void fail(const TextToken& at, const std::string& what,
                           const std::string& remedy) const {
        throw_input_error(reader_.position(at), what, remedy);
    }

    std::vector<TextToken> tokens_of(std::string_view line) const {
        if (trimmed(line).starts_with('#'))
            return {};
        return reader_.split_at_blanks(line);
    }

    void read_norm(const TextToken& token) {
        if (!values_.empty())
            fail(token, "SPECTRAL_NORM stands behind the data", "move it above BEGIN_DATA");
        const double value = reader_.number(token);
        if (!(value >= 1e-6 && value <= 1e6))
            fail(token, fmt::format("a norm of {}", value), "it is 1, or 100 for percent");
        if (norm_ && *norm_ != value)
            fail(token, "SPECTRAL_NORM is given twice", "give it once");
        norm_ = value;
    }

    /// Appends the tokens up to the line that ends the section.
    void read_section(std::vector<TextToken>& tokens, std::string_view end) {
        for (std::string_view line; reader_.next_line(line);) {
            const auto more = tokens_of(line);
            if (!more.empty() && upper_case(more[0].text) == end)
                return;
            tokens.insert(tokens.end(), more.begin(), more.end());
        }
        throw_input_error(reader_.end_position(), fmt::format("{} is missing", end),
                          "the file is cut off: copy it again");
    }

    void read_fields() {
        if (!fields_.empty())
            throw_input_error(reader_.end_position(), "a second table follows",
                              "give a file of one spectrum");
        read_section(fields_, "END_DATA_FORMAT");
        if (fields_.empty())
            throw_input_error(reader_.end_position(), "the data have no fields",
                              "name them, such as SPECTRAL_NM400");
    }

    void read_data(const TextToken& begin) {
        if (fields_.empty() || !values_.empty())
            fail(begin, fields_.empty() ? "no BEGIN_DATA_FORMAT before" : "a second table follows",
                 "give a file of one spectrum");
        read_section(values_, "END_DATA");
        const std::size_t sets = values_.size() / fields_.size();
        if (values_.empty() || values_.size() % fields_.size() != 0)
            fail(values_.empty() ? begin : values_.back(),
                 fmt::format("{} values for {} fields", values_.size(), fields_.size()),
                 "every set has a value for each field");
        if (sets != 1 || (sets_ && *sets_ != 1.0))
            fail(begin,
                 fmt::format("{} sets of data, not one", sets_.value_or(static_cast<double>(sets))),
                 "keep the set whose spectrum is wanted");
    }

    void add(double nm, const TextToken& value, double divisor) {
        table_.columns[0].push_back(nm);
        table_.columns[1].push_back(reader_.number(value) / divisor);
        table_.places.push_back({value.line, value.column});
    }

    void assign() {
        double nm = 0.0; // of the SPECTRAL_NM whose value comes next
        for (std::size_t k = 0; k < fields_.size(); ++k) {
            const Field field = field_of(upper_case(fields_[k].text), reader_.position(fields_[k]));
            switch (field.kind) {
            case Field::Kind::Other:
                break;
            case Field::Kind::Value:
                add(field.nm, values_[k], norm_.value_or(1.0));
                break;
            case Field::Kind::Wavelength:
                nm = reader_.wavelength_nm(values_[k]);
                break;
            case Field::Kind::Decimal:
            case Field::Kind::Percent:
                if (nm == 0.0)
                    fail(fields_[k], "a value without its SPECTRAL_NM",
                         "write SPECTRAL_NM before it");
                add(nm, values_[k], field.kind == Field::Kind::Percent ? 100.0 : 1.0);
                nm = 0.0;
                break;
            }
        }
        if (table_.places.empty())
            fail(fields_.front(), "no field holds a spectrum",
                 "fields such as SPECTRAL_NM400 or SPEC_400 are read");
    }

    TextReader reader_;
    std::vector<TextToken> fields_, values_;
    std::optional<double> norm_; ///< what stands for 1 (Argyll: 100 where values are percent)
    std::optional<double> sets_;
    UnsortedTable table_;
};

} // namespace

NumberTable read_cgats(const std::filesystem::path& file) {
    return CgatsReader(file).read();
}

} // namespace reradiant
