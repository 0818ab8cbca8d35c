#include "host/spectral/files/matrix_formats.h"

#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/spectral/text/text_reader.h"

#include <fmt/core.h>

#include <array>
#include <cmath>

// Matrix file of the Labsphere BFC-450 bispectral fluorescence colorimeter: lines that end in
// CR LF, fields between tabs. Two lines of identification, comments after ';', a line of emission
// from, to, step, then excitation count, from, step, a line "r:c:" with the excitation
// wavelengths, one row per emission wavelength, and "EOD". Entries off the diagonal are weighted
// by the emission bandpass (CIE 17-21-101).

namespace reradiant {

namespace {

constexpr double same_nm = 1e-6;

class BfcReader {
public:
    explicit BfcReader(const std::filesystem::path& file) : reader_(file, TextFormat::Bfc) {}

    ReradiationMatrix read() {
        if (const auto tokens = next(); tokens[0].text != "VEC_01")
            throw_input_error(reader_.position(tokens[0]), "this is no BFC-450 matrix file",
                              "it begins with VEC_01");
        std::string_view title;
        if (!reader_.next_line(title) || !trimmed(title).starts_with("BFC-450"))
            throw_input_error(reader_.position(2, 1), "this is no BFC-450 matrix file",
                              "its second line is 'BFC-450 Matrix File'");
        read_grids();
        read_excitation_wavelengths();
        read_rows();
        matrix_.kind = MatrixKind::Measured;
        scale_off_diagonal(matrix_, matrix_.excitation.step_nm / matrix_.emission.step_nm);
        return matrix_;
    }

private:
    /// Fields of the next line that is neither empty nor a comment.
    std::vector<TextToken> next() {
        for (std::string_view line; reader_.next_line(line);) {
            if (trimmed(line).starts_with(';'))
                continue;
            if (auto tokens = reader_.split_at_blanks(line); !tokens.empty())
                return tokens;
        }
        throw_input_error(reader_.end_position(), "the file ends before its matrix does",
                          "its last line is EOD");
    }

    void require_fields(const std::vector<TextToken>& tokens, std::size_t count,
                        const char* what) const {
        if (tokens.size() != count)
            throw_input_error(reader_.position(tokens.back()),
                              fmt::format("{} fields in {}", tokens.size(), what),
                              fmt::format("{} are needed", count));
    }

    void read_grids() {
        const auto tokens = next();
        require_fields(tokens, 6, "the line of ranges");
        std::array<double, 6> v{};
        for (std::size_t k = 0; k < v.size(); ++k)
            v[k] = reader_.wavelength_nm(tokens[k]);
        if (v[3] != std::floor(v[3]))
            throw_input_error(reader_.position(tokens[3]), "the count is not a whole number",
                              "write the number of excitation wavelengths");
        try {
            matrix_.emission = grid_from_range(v[0], v[1], v[2]);
            matrix_.excitation = grid_from_range(v[4], v[4] + (v[3] - 1.0) * v[5], v[5]);
        } catch (const std::invalid_argument& error) {
            throw_input_error(reader_.position(tokens[0]), error.what(),
                              "write emission from, to, step, excitation count, from, step");
        }
        require_matrix_size(reader_.position(tokens[0]),
                            static_cast<std::size_t>(matrix_.emission.count),
                            static_cast<std::size_t>(matrix_.excitation.count));
    }

    void require_wavelength(const TextToken& token, double expected_nm) const {
        if (const double nm = reader_.wavelength_nm(token); std::abs(nm - expected_nm) > same_nm)
            throw_input_error(reader_.position(token),
                              fmt::format("{} nm disagrees with the line of ranges", nm),
                              fmt::format("{} nm belongs here", expected_nm));
    }

    void read_excitation_wavelengths() {
        const auto tokens = next();
        if (tokens[0].text != "r:c:")
            throw_input_error(reader_.position(tokens[0]), "the excitation wavelengths are missing",
                              "their line begins with r:c:");
        require_fields(tokens, static_cast<std::size_t>(matrix_.excitation.count) + 1,
                       "the line of excitation wavelengths");
        for (int i = 0; i < matrix_.excitation.count; ++i)
            require_wavelength(tokens[static_cast<std::size_t>(i) + 1],
                               matrix_.excitation.centre_nm(i));
    }

    void read_rows() {
        matrix_.values.setZero(matrix_.emission.count, matrix_.excitation.count);
        for (int o = 0; o < matrix_.emission.count; ++o) {
            const auto tokens = next();
            require_wavelength(tokens[0], matrix_.emission.centre_nm(o));
            require_fields(tokens, static_cast<std::size_t>(matrix_.excitation.count) + 1,
                           "a row of the matrix");
            for (int i = 0; i < matrix_.excitation.count; ++i)
                matrix_.values(o, i) = reader_.number(tokens[static_cast<std::size_t>(i) + 1]);
        }
        if (const auto tokens = next(); tokens[0].text != "EOD")
            throw_input_error(reader_.position(tokens[0]), "a row too many", "EOD belongs here");
    }

    TextReader reader_;
    ReradiationMatrix matrix_;
};

} // namespace

ReradiationMatrix read_matrix_bfc(const std::filesystem::path& file) {
    return BfcReader(file).read();
}

void write_matrix_bfc(const std::filesystem::path& file, const ReradiationMatrix& matrix) {
    if (matrix.kind == MatrixKind::Model)
        logging::warn("{}: a BFC file reads back as a measurement; write CSV to keep a model",
                      file.string());
    ReradiationMatrix scaled = matrix;
    scale_off_diagonal(scaled, matrix.emission.step_nm / matrix.excitation.step_nm);
    // 5167 stands in the first line of every file of the instrument that we have seen.
    std::string text = "VEC_01\t5167\r\nBFC-450 Matrix File\r\n;written by reradiant\r\n";
    text += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\r\nr:c:", matrix.emission.from_nm,
                        matrix.emission.to_nm(), matrix.emission.step_nm, matrix.excitation.count,
                        matrix.excitation.from_nm, matrix.excitation.step_nm);
    for (int i = 0; i < matrix.excitation.count; ++i)
        text += fmt::format("\t{}", matrix.excitation.centre_nm(i));
    text += "\r\n";
    for (int o = 0; o < matrix.emission.count; ++o) {
        text += fmt::format("{}", matrix.emission.centre_nm(o));
        for (int i = 0; i < matrix.excitation.count; ++i)
            text += fmt::format("\t{}", scaled.values(o, i));
        text += "\r\n";
    }
    write_text_atomically(file, text + "EOD\r\n");
}

} // namespace reradiant
