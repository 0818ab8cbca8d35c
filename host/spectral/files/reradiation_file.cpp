#include "reradiant/spectral_files.h"

#include "host/base/output_ending.h"
#include "host/spectral/evidence/matrix_evidence.h"
#include "host/spectral/evidence/plausible_matrix.h"
#include "host/spectral/files/matrix_formats.h"
#include "host/spectral/text/text_format.h"

#include <fmt/core.h>

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

/// Exchanged rows and columns are the usual cause, and show.
std::string remedy_of_anti_stokes(const ReradiationMatrix& matrix) {
    std::string remedy = "set it to 0, or write '# kind: measured' where it is noise and '# "
                         "anti-stokes: allowed' where it is real (`reradiant convert` with --kind "
                         "measured, --anti-stokes)";
    const MatrixEvidence evidence = evidence_of(matrix);
    if (evidence.stands_out && evidence.anti_stokes > evidence.stokes)
        return fmt::format("{:.0f} % of the fluorescence is, so that rows and columns are probably "
                           "exchanged: declare the other '# orientation'; else {}",
                           100.0 * evidence.anti_stokes_share(), remedy);
    return remedy;
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
                    remedy_of_anti_stokes(matrix));
}

bool holds_reradiation(const std::filesystem::path& file) {
    const std::string ending = lower_case_ending(file);
    if (ending == ".bfc" || ending == ".exr")
        return true;
    return text_format_of(file) == TextFormat::Table && declares_reradiation(file).has_value();
}

ReradiationMatrix read_reradiation(const std::filesystem::path& file, Gaps gaps,
                                   const TableForm& form) {
    const std::string ending = lower_case_ending(file);
    const bool is_exr = ending == ".exr", is_bfc = ending == ".bfc";
    if ((is_exr || is_bfc) && form != TableForm{})
        throw_input_error({file.string()},
                          fmt::format("a {} file says itself how its numbers are meant",
                                      is_exr ? "bispectral EXR" : "BFC-450"),
                          "tell that of plain tables only");
    const ReradiationMatrix matrix = is_exr   ? read_matrix_exr(file)
                                     : is_bfc ? read_matrix_bfc(file)
                                              : read_matrix_csv(file, gaps, form);
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
