#include "host/spectral/matrix_io.h"

#include "host/spectral/matrix_formats.h"
#include "host/spectral/plausible_matrix.h"
#include "host/spectral/text_format.h"

#include <fmt/format.h>

#include <stdexcept>

namespace reradiant {

namespace {

constexpr std::size_t most_entries = std::size_t{1} << 22;

[[noreturn]] void refuse_ending(const std::filesystem::path& file) {
    throw_input_error(
        {file.string()},
        fmt::format("the ending '{}' is not of a re-radiation matrix", file.extension().string()),
        "use .csv, .bfc or .exr");
}

} // namespace

void require_matrix_size(const SourcePosition& position, std::size_t rows, std::size_t columns) {
    if (columns > 0 && rows > most_entries / columns)
        throw_input_error(position, fmt::format("{} x {} entries are too many", rows, columns),
                          fmt::format("at most {} are read", most_entries));
}

void scale_off_diagonal(ReradiationMatrix& matrix, double factor) {
    for (int i = 0; i < matrix.excitation.count; ++i) {
        const int diagonal = diagonal_row(matrix, i);
        for (int o = 0; o < matrix.emission.count; ++o)
            if (o != diagonal)
                matrix.values(o, i) *= factor;
    }
}

void refuse_undeclared_anti_stokes(const ReradiationMatrix& matrix,
                                   const SourcePosition& position) {
    if (matrix.kind == MatrixKind::Measured || matrix.anti_stokes_allowed)
        return;
    for (int i = 0; i < matrix.excitation.count; ++i)
        for (int o = 0; o < matrix.emission.count; ++o)
            if (matrix.values(o, i) > 0.0 && diagonal_row(matrix, i) != o &&
                matrix.emission.centre_nm(o) < matrix.excitation.centre_nm(i))
                throw_input_error(
                    position,
                    fmt::format("excitation {} nm, emission {} nm: the value {} is anti-Stokes",
                                matrix.excitation.centre_nm(i), matrix.emission.centre_nm(o),
                                matrix.values(o, i)),
                    "set it to 0, or declare anti-Stokes emission as allowed");
}

bool holds_reradiation(const std::filesystem::path& file) {
    const std::string ending = lower_case_ending(file);
    if (ending == ".bfc" || ending == ".exr")
        return true;
    return text_format_of(file) == TextFormat::Table && declares_reradiation(file).has_value();
}

ReradiationMatrix read_reradiation(const std::filesystem::path& file, Gaps gaps) {
    const std::string ending = lower_case_ending(file);
    ReradiationMatrix matrix;
    if (ending == ".csv")
        matrix = read_matrix_csv(file, gaps);
    else if (ending == ".bfc")
        matrix = read_matrix_bfc(file);
    else if (ending == ".exr")
        matrix = read_matrix_exr(file);
    else
        refuse_ending(file);
    require_plausible_matrix(matrix, file);
    return matrix;
}

void write_reradiation(const std::filesystem::path& file, const ReradiationMatrix& matrix) {
    const std::string ending = lower_case_ending(file);
    if (ending == ".csv")
        return write_reradiation_csv(file, matrix, {});
    if (ending == ".bfc")
        return write_matrix_bfc(file, matrix);
    if (ending == ".exr")
        return write_matrix_exr(file, matrix);
    refuse_ending(file);
}

} // namespace reradiant
