#include "reradiant/reradiation.h"

#include "host/base/atomic_file.h"
#include "host/spectral/files/matrix_formats.h"
#include "host/spectral/text/csv_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

constexpr const char* first_line = "# reradiation covariance";
constexpr const char* of_matrix = "matrix";
constexpr const char* of_entries = "independent";
/// Cells of a row before its values: the part, the emission.
constexpr std::size_t heads = 2;

/// Reads the parts of a covariance, a row of an emission band a line.
class CovarianceReader {
public:
    explicit CovarianceReader(const std::filesystem::path& file) : reader_(file) {}

    MatrixCovariance read() {
        require_first_line();
        read_headings(next_cells());
        MatrixCovariance covariance;
        std::vector<TextToken> row = next_cells();
        std::vector<Matrix> directions;
        while (!row.empty()) {
            const TextToken name = row[0];
            if (name.text == of_matrix && !covariance.matrix)
                covariance.matrix = part(row);
            else if (name.text == of_entries && covariance.independent.size() == 0)
                covariance.independent = part(row);
            else if (name.text == std::to_string(directions.size() + 1))
                directions.push_back(part(row));
            else
                refuse_part(name, directions.size());
        }
        require_whole(covariance, directions.size());
        covariance.emission = axis_grid(emission_, "emission", 1.0);
        covariance.excitation = axis_grid(excitation_, "excitation", 1.0);
        covariance.directions.resize(covariance.independent.size(),
                                     static_cast<Eigen::Index>(directions.size()));
        for (std::size_t k = 0; k < directions.size(); ++k)
            covariance.directions.col(static_cast<Eigen::Index>(k)) = directions[k].reshaped();
        return covariance;
    }

private:
    void require_first_line() {
        std::string_view line;
        if (!reader_.next_line(line) || without_padding(line) != first_line)
            throw_input_error(
                reader_.position(1, 1), "this is no covariance of a re-radiation matrix",
                fmt::format("its first line is '{}', as `fit --covariance` writes it", first_line));
    }

    /// Cells of the next line that has any; empty behind the last.
    std::vector<TextToken> next_cells() {
        for (std::string_view line; reader_.next_line(line);) {
            if (is_remark(line))
                read_remark(line);
            else if (is_line_of_cells(line))
                return reader_.split_cells(line);
        }
        return {};
    }

    void read_remark(std::string_view line) {
        const auto entry = header_entry(reader_, line);
        if (!entry)
            return;
        const auto require = [&](std::string_view only) {
            if (entry->value.text != only)
                throw_input_error(reader_.position(entry->value),
                                  fmt::format("'{}' is not known", entry->value.text),
                                  fmt::format("write {}", only));
        };
        if (entry->name == "quantity")
            require("per-band");
        else if (entry->name == "orientation")
            require("rows-emission");
        else if (entry->name == "directions")
            expected_ = reader_.number(entry->value);
    }

    void read_headings(const std::vector<TextToken>& cells) {
        if (cells.size() <= heads || cells[0].text != "part" || cells[1].text != "nm")
            throw_input_error(cells.empty() ? reader_.end_position() : reader_.position(cells[0]),
                              "no line of headings", "write 'part,nm,300,310,...'");
        for (std::size_t k = heads; k < cells.size(); ++k)
            excitation_.push_back({reader_.wavelength_nm(cells[k]), reader_.position(cells[k]),
                                   half_last_digit(cells[k].text)});
    }

    /// All rows of the part that `row` begins; `row` becomes the first of the next.
    Matrix part(std::vector<TextToken>& row) {
        const std::string name(row[0].text);
        const bool sets_bands = emission_.empty();
        std::vector<double> values;
        std::size_t band = 0;
        TextToken last = row[0];
        for (; !row.empty() && row[0].text == name; row = next_cells(), ++band) {
            last = row[0];
            take_band(row, band, sets_bands);
            for (std::size_t k = heads; k < row.size(); ++k)
                values.push_back(value(row[k], name == of_entries));
            require_matrix_size(reader_.position(last), band + 1, excitation_.size());
        }
        if (band != emission_.size())
            throw_input_error(reader_.position(last),
                              fmt::format("part '{}' ends after {} rows", name, band),
                              fmt::format("every part has {}", emission_.size()));
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        return Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(band),
                                          static_cast<Eigen::Index>(excitation_.size()));
    }

    /// Checks a row against its place; the first part says which bands there are.
    void take_band(const std::vector<TextToken>& row, std::size_t band, bool sets_bands) {
        if (row.size() != heads + excitation_.size())
            throw_input_error(reader_.position(row.back()),
                              fmt::format("{} cells in this row", row.size()),
                              fmt::format("the headings name {}", heads + excitation_.size()));
        const double nm = reader_.wavelength_nm(row[1]);
        if (sets_bands)
            emission_.push_back({nm, reader_.position(row[1]), half_last_digit(row[1].text)});
        else if (band >= emission_.size() || emission_[band].nm != nm)
            throw_input_error(reader_.position(row[1]),
                              fmt::format("emission {} nm where the first part has {}", nm,
                                          band < emission_.size()
                                              ? fmt::format("{} nm", emission_[band].nm)
                                              : std::string("no row any more")),
                              "every part has the same rows in the same order");
    }

    double value(const TextToken& cell, bool is_error) const {
        if (is_error && is_gap(cell.text))
            return std::numeric_limits<double>::quiet_NaN();
        const double number = reader_.number(cell);
        if (is_error && number < 0.0)
            throw_input_error(reader_.position(cell), fmt::format("a standard error of {}", number),
                              "it is at least 0");
        return number;
    }

    [[noreturn]] void refuse_part(const TextToken& name, std::size_t directions) const {
        throw_input_error(
            reader_.position(name), fmt::format("part '{}' has no place here", name.text),
            fmt::format(
                "the next one is {}{}", directions + 1,
                directions > 0 ? "" : fmt::format(", {} or {}, each once", of_matrix, of_entries)));
    }

    void require_whole(const MatrixCovariance& covariance, std::size_t directions) const {
        if (covariance.independent.size() == 0)
            throw_input_error(reader_.end_position(), fmt::format("no part '{}'", of_entries),
                              "it holds the errors that no other entry shares, perhaps zeros");
        if (!expected_ || *expected_ != static_cast<double>(directions))
            throw_input_error(
                reader_.end_position(), fmt::format("the file holds {} directions", directions),
                expected_ ? fmt::format("its head promises {}: it is not whole", *expected_)
                          : fmt::format("say so in a line '# directions: {}'", directions));
    }

    TextReader reader_;
    std::optional<double> expected_;
    std::vector<PlacedWavelength> emission_, excitation_;
};

void append_part(std::string& text, const std::string& name, const Matrix& values,
                 const WavelengthGrid& emission, const char* number_form) {
    for (int o = 0; o < emission.count; ++o) {
        text += fmt::format("{},{}", name, emission.centre_nm(o));
        for (Eigen::Index i = 0; i < values.cols(); ++i) {
            text += ',';
            if (const double value = values(o, i); value == 0.0)
                text += '0';
            else
                text += fmt::format(fmt::runtime(number_form), value);
        }
        text += '\n';
    }
}

} // namespace

MatrixCovariance read_covariance_csv(const std::filesystem::path& file) {
    return CovarianceReader(file).read();
}

void write_covariance_csv(const std::filesystem::path& file, const MatrixCovariance& covariance) {
    const Matrix& directions = covariance.directions;
    std::string text = fmt::format(
        "{}\n# quantity: per-band\n# orientation: rows-emission\n# directions: {}\n"
        "# The covariance of two entries is the sum over the directions 1, 2, ... of the product "
        "of their values,\n# and the square of `independent` more where both are the same entry.\n"
        "part,nm",
        first_line, directions.cols());
    for (const double nm : covariance.excitation.centres_nm())
        text += fmt::format(",{}", nm);
    text += '\n';
    if (covariance.matrix)
        append_part(text, of_matrix, *covariance.matrix, covariance.emission, "{}");
    append_part(text, of_entries, covariance.independent, covariance.emission, "{:.6g}");
    for (Eigen::Index k = 0; k < directions.cols(); ++k)
        append_part(
            text, std::to_string(k + 1),
            directions.col(k).reshaped(covariance.emission.count, covariance.excitation.count),
            covariance.emission, "{:.6g}");
    write_text_atomically(file, text);
}

} // namespace reradiant
