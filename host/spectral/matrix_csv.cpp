#include "host/atomic_file.h"
#include "host/spectral/matrix_formats.h"
#include "host/spectral/matrix_io.h"
#include "host/spectral/text_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace reradiant {

namespace {

/// What the '#' lines say. Quantity and orientation are never guessed.
struct CsvHeader {
    std::optional<MatrixQuantity> quantity;
    std::optional<bool> rows_are_emission;
    std::optional<MatrixKind> kind;
    std::optional<bool> anti_stokes_allowed;
    std::optional<std::string> geometry;
    std::optional<double> emission_step_nm, excitation_step_nm; ///< for an axis of one band
};

std::string_view first_word(std::string_view text) {
    return text.substr(0, std::min(text.find_first_of(" \t"), text.size()));
}

template <typename Value>
void set_once(const TextReader& reader, const TextToken& key, std::optional<Value>& field,
              const Value& value) {
    if (field)
        throw_input_error(reader.position(key), fmt::format("'{}' is given twice", key.text),
                          "keep one of the two lines");
    field = value;
}

/// One of two words, or an input Error.
bool is_first_of(const TextReader& reader, const TextToken& value, std::string_view first,
                 std::string_view second) {
    const std::string_view word = first_word(value.text);
    if (word != first && word != second)
        throw_input_error(reader.position(value), fmt::format("'{}' is not known here", word),
                          fmt::format("write {} or {}", first, second));
    return word == first;
}

double step_value(const TextReader& reader, TextToken value) {
    value.text = first_word(value.text);
    return reader.wavelength_nm(value);
}

void read_header_line(const TextReader& reader, std::string_view line, CsvHeader& header) {
    const auto colon = line.find(':');
    if (colon == std::string_view::npos)
        return;
    const auto hash = line.find('#');
    const std::string_view name = trimmed(line.substr(hash + 1, colon - hash - 1));
    const std::string_view rest = trimmed(line.substr(colon + 1));
    const auto column_of = [&](std::string_view part) {
        return part.empty() ? static_cast<int>(colon) + 2
                            : static_cast<int>(part.data() - line.data()) + 1;
    };
    const TextToken key{name, reader.line_number(), column_of(name)};
    const TextToken value{rest, reader.line_number(), column_of(rest)};
    if (name == "quantity")
        set_once(reader, key, header.quantity,
                 is_first_of(reader, value, "per-band", "density-per-nm")
                     ? MatrixQuantity::PerBand
                     : MatrixQuantity::DensityPerNm);
    else if (name == "orientation")
        set_once(reader, key, header.rows_are_emission,
                 is_first_of(reader, value, "rows-emission", "rows-excitation"));
    else if (name == "kind")
        set_once(reader, key, header.kind,
                 is_first_of(reader, value, "model", "measured") ? MatrixKind::Model
                                                                 : MatrixKind::Measured);
    else if (name == "anti-stokes")
        set_once(reader, key, header.anti_stokes_allowed,
                 is_first_of(reader, value, "allowed", "refused"));
    else if (name == "geometry")
        set_once(reader, key, header.geometry, std::string(rest));
    else if (name == "emission-step-nm")
        set_once(reader, key, header.emission_step_nm, step_value(reader, value));
    else if (name == "excitation-step-nm")
        set_once(reader, key, header.excitation_step_nm, step_value(reader, value));
}

void require_declared(const TextReader& reader, const CsvHeader& header) {
    const SourcePosition position = reader.position(std::max(1, reader.line_number()), 1);
    if (!header.quantity)
        throw_input_error(position, "the quantity is not declared",
                          "add the line '# quantity: per-band' or '# quantity: density-per-nm'");
    if (!header.rows_are_emission)
        throw_input_error(
            position, "the orientation is not declared",
            "add the line '# orientation: rows-emission' or '# orientation: rows-excitation'");
}

/// Both axes and the values, rows = emission, in the file's quantity.
struct CsvBody {
    std::vector<PlacedWavelength> emission, excitation;
    Eigen::MatrixXd values;
};

std::vector<PlacedWavelength> heading_wavelengths(const TextReader& reader,
                                                  const std::vector<TextToken>& tokens) {
    if (tokens.size() < 2)
        throw_input_error(reader.position(tokens[0]), "no wavelengths in the line of headings",
                          "write 'nm,300,310,...'");
    std::vector<PlacedWavelength> axis;
    for (std::size_t k = 1; k < tokens.size(); ++k)
        axis.push_back({reader.wavelength_nm(tokens[k]), reader.position(tokens[k])});
    return axis;
}

double entry_value(const TextReader& reader, const TextToken& token, Gaps gaps) {
    if (gaps == Gaps::BecomeNan && token.text == "nan")
        return std::numeric_limits<double>::quiet_NaN();
    return reader.number(token);
}

CsvBody read_wide(TextReader& reader, const std::vector<TextToken>& headings,
                  bool rows_are_emission, Gaps gaps) {
    const std::vector<PlacedWavelength> columns = heading_wavelengths(reader, headings);
    std::vector<PlacedWavelength> rows;
    std::vector<double> values;
    for (std::string_view line; reader.next_line(line);) {
        if (trimmed(line).empty() || trimmed(line).starts_with('#'))
            continue;
        const std::vector<TextToken> tokens = reader.split_at_commas(line);
        if (tokens.size() != headings.size())
            throw_input_error(reader.position(tokens.back()),
                              fmt::format("{} values in this row", tokens.size() - 1),
                              fmt::format("the headings name {}", columns.size()));
        rows.push_back({reader.wavelength_nm(tokens[0]), reader.position(tokens[0])});
        require_matrix_size(rows.back().position, rows.size(), columns.size());
        for (std::size_t k = 1; k < tokens.size(); ++k)
            values.push_back(entry_value(reader, tokens[k], gaps));
    }
    if (rows.empty())
        throw_input_error(reader.position(reader.line_number(), 1), "no rows after the headings",
                          "every row holds a wavelength and its values");
    const Eigen::MatrixXd table =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            values.data(), static_cast<Eigen::Index>(rows.size()),
            static_cast<Eigen::Index>(columns.size()));
    if (rows_are_emission)
        return {rows, columns, table};
    return {columns, rows, table.transpose()};
}

struct LongEntry {
    double value;
    SourcePosition position;
};
using LongEntries = std::map<std::pair<double, double>, LongEntry>; // (emission, excitation)

LongEntries read_long_entries(TextReader& reader, Gaps gaps) {
    LongEntries entries;
    for (std::string_view line; reader.next_line(line);) {
        if (trimmed(line).empty() || trimmed(line).starts_with('#'))
            continue;
        const std::vector<TextToken> tokens = reader.split_at_commas(line);
        if (tokens.size() != 3)
            throw_input_error(reader.position(tokens.back()),
                              fmt::format("{} values in this line", tokens.size()),
                              "write excitation_nm,emission_nm,value");
        const std::pair key{reader.wavelength_nm(tokens[1]), reader.wavelength_nm(tokens[0])};
        const LongEntry entry{entry_value(reader, tokens[2], gaps), reader.position(tokens[0])};
        if (!entries.emplace(key, entry).second)
            throw_input_error(entry.position,
                              fmt::format("excitation {} nm, emission {} nm is given twice",
                                          key.second, key.first),
                              "keep one of the two lines");
        require_matrix_size(entry.position, entries.size(), 1);
    }
    if (entries.empty())
        throw_input_error(reader.position(reader.line_number(), 1), "no values after the headings",
                          "every line holds excitation_nm,emission_nm,value");
    return entries;
}

CsvBody read_long(TextReader& reader, Gaps gaps) {
    const LongEntries entries = read_long_entries(reader, gaps);
    std::map<double, SourcePosition> emission, excitation;
    for (const auto& [key, entry] : entries) {
        emission.emplace(key.first, entry.position);
        excitation.emplace(key.second, entry.position);
    }
    CsvBody body;
    for (const auto& [nm, position] : emission)
        body.emission.push_back({nm, position});
    for (const auto& [nm, position] : excitation)
        body.excitation.push_back({nm, position});
    require_matrix_size(reader.position(1, 1), emission.size(), excitation.size());
    body.values.setZero(static_cast<Eigen::Index>(emission.size()),
                        static_cast<Eigen::Index>(excitation.size()));
    for (std::size_t o = 0; o < body.emission.size(); ++o) {
        for (std::size_t i = 0; i < body.excitation.size(); ++i) {
            const double emission_nm = body.emission[o].nm, excitation_nm = body.excitation[i].nm;
            const auto found = entries.find({emission_nm, excitation_nm});
            // Impossible entries may be left out; any other gap is a mistake.
            if (found == entries.end() && gaps == Gaps::BecomeNan)
                body.values(static_cast<Eigen::Index>(o), static_cast<Eigen::Index>(i)) =
                    std::numeric_limits<double>::quiet_NaN();
            else if (found == entries.end() && emission_nm >= excitation_nm)
                throw_input_error(body.emission[o].position,
                                  fmt::format("excitation {} nm, emission {} nm is missing",
                                              excitation_nm, emission_nm),
                                  "only emission below its excitation may be left out");
            if (found != entries.end())
                body.values(static_cast<Eigen::Index>(o), static_cast<Eigen::Index>(i)) =
                    found->second.value;
        }
    }
    return body;
}

ReradiationMatrix assemble(const CsvHeader& header, CsvBody body) {
    const auto spacing = [](const std::vector<PlacedWavelength>& axis) {
        return axis.size() > 1 && axis[1].nm > axis[0].nm ? axis[1].nm - axis[0].nm : 1.0;
    };
    ReradiationMatrix matrix;
    // An axis of one band is as wide as it says, else as the other axis's bands.
    matrix.emission = axis_grid(body.emission, "emission",
                                header.emission_step_nm.value_or(spacing(body.excitation)));
    matrix.excitation = axis_grid(body.excitation, "excitation",
                                  header.excitation_step_nm.value_or(spacing(body.emission)));
    matrix.values = std::move(body.values);
    matrix.kind = header.kind.value_or(MatrixKind::Model);
    matrix.anti_stokes_allowed = header.anti_stokes_allowed.value_or(false);
    matrix.geometry = header.geometry.value_or("");
    if (*header.quantity == MatrixQuantity::DensityPerNm)
        scale_off_diagonal(matrix, matrix.excitation.step_nm);
    return matrix;
}

std::string header_text(const ReradiationMatrix& matrix, const MatrixCsvForm& form) {
    std::string text =
        fmt::format("# reradiation\n# quantity: {}\n# orientation: {}\n# kind: {}\n",
                    form.quantity == MatrixQuantity::PerBand ? "per-band" : "density-per-nm",
                    form.rows_are_emission ? "rows-emission" : "rows-excitation",
                    matrix.kind == MatrixKind::Model ? "model" : "measured");
    std::string geometry = matrix.geometry;
    std::replace_if(
        geometry.begin(), geometry.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    if (!geometry.empty())
        text += fmt::format("# geometry: {}\n", geometry);
    if (matrix.anti_stokes_allowed)
        text += "# anti-stokes: allowed\n";
    if (matrix.emission.count == 1)
        text += fmt::format("# emission-step-nm: {}\n", matrix.emission.step_nm);
    if (matrix.excitation.count == 1)
        text += fmt::format("# excitation-step-nm: {}\n", matrix.excitation.step_nm);
    return text;
}

} // namespace

ReradiationMatrix read_matrix_csv(const std::filesystem::path& file, Gaps gaps) {
    TextReader reader(file);
    CsvHeader header;
    for (std::string_view line; reader.next_line(line);) {
        if (trimmed(line).empty())
            continue;
        if (trimmed(line).starts_with('#')) {
            read_header_line(reader, line, header);
            continue;
        }
        require_declared(reader, header);
        const std::vector<TextToken> headings = reader.split_at_commas(line);
        const bool is_long = headings[0].text == "excitation_nm";
        if (is_long && (headings.size() != 3 || headings[1].text != "emission_nm" ||
                        headings[2].text != "value"))
            throw_input_error(reader.position(headings[0]), "these headings are not known",
                              "write excitation_nm,emission_nm,value");
        if (!is_long && headings[0].text != "nm")
            throw_input_error(reader.position(headings[0]), "the line of headings is missing",
                              "begin it with 'nm,' or write excitation_nm,emission_nm,value");
        const ReradiationMatrix matrix = assemble(
            header, is_long ? read_long(reader, gaps)
                            : read_wide(reader, headings, *header.rows_are_emission, gaps));
        refuse_undeclared_anti_stokes(matrix, reader.position(headings[0]));
        return matrix;
    }
    throw_input_error(reader.position(std::max(1, reader.line_number()), 1),
                      "no matrix in this file", "see 'Re-radiation CSV' in the README");
}

void write_reradiation_csv(const std::filesystem::path& file, const ReradiationMatrix& matrix,
                           const MatrixCsvForm& form) {
    ReradiationMatrix scaled = matrix;
    if (form.quantity == MatrixQuantity::DensityPerNm)
        scale_off_diagonal(scaled, 1.0 / matrix.excitation.step_nm);
    const Eigen::MatrixXd table =
        form.rows_are_emission ? scaled.values : Eigen::MatrixXd(scaled.values.transpose());
    const WavelengthGrid& rows = form.rows_are_emission ? matrix.emission : matrix.excitation;
    const WavelengthGrid& columns = form.rows_are_emission ? matrix.excitation : matrix.emission;
    std::string text = header_text(matrix, form) + "nm";
    for (int column = 0; column < columns.count; ++column)
        text += fmt::format(",{}", columns.centre_nm(column));
    text += '\n';
    for (int row = 0; row < rows.count; ++row) {
        text += fmt::format("{}", rows.centre_nm(row));
        // fmt prints the shortest text that reads back as the same double.
        for (int column = 0; column < columns.count; ++column)
            text += fmt::format(",{}", table(row, column));
        text += '\n';
    }
    write_text_atomically(file, text);
}

} // namespace reradiant
