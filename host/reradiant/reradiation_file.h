#pragma once

#include "reradiant/reradiation.h"
#include "reradiant/table_form.h"

#include <filesystem>

namespace reradiant {

/// `Gaps` says what becomes of an entry that was not measured: it is refused, or becomes NaN. Such
/// an entry is `nan`, `NA`, `--`, an empty cell and so on (is_gap of text_reader.h), or absent from
/// the long form of a CSV.
enum class Gaps { Refused, BecomeNan };

/// Reads a re-radiation matrix by its ending: .bfc (Labsphere BFC-450; kind = measured), .exr
/// (bispectral, Fichet, Pacanowski and Wilkie 2021), else text (spectra/README.md: wide or long
/// form, per-band or density-per-nm, either orientation). Values are converted to per-band form
/// with rows = emission, axes ascending, but otherwise raw: nothing is repaired or checked for
/// energy here. What cannot be in nm and unit 1 (plausible_matrix.h) is refused. With a `form`,
/// gaps below the excitation of a wide table are 0. Throws an input Error with file, line and
/// column, also for a `form` given to .bfc and .exr.
ReradiationMatrix read_reradiation(const std::filesystem::path& file, Gaps gaps = Gaps::Refused,
                                   const TableForm& form = {});

/// Writes by ending: .csv (wide, per-band, rows-emission), .bfc or .exr. Atomic: a temporary
/// file beside it, fsync, rename. At least 9 significant digits (17 where needed to read back
/// the same double).
void write_reradiation(const std::filesystem::path& file, const ReradiationMatrix& matrix);

/// A `MatrixCsvForm` says how a CSV lays a matrix out (spectra/README.md).
struct MatrixCsvForm {
    MatrixQuantity quantity = MatrixQuantity::PerBand;
    bool rows_are_emission = true;
};
/// The wide CSV in a chosen form; atomic.
void write_reradiation_csv(const std::filesystem::path& file, const ReradiationMatrix& matrix,
                           const MatrixCsvForm& form);

/// True when a file holds a re-radiation matrix rather than a spectrum: .bfc, .exr, or a text
/// whose first lines say so or are headed by wavelengths. Input Error when it cannot be read.
bool holds_reradiation(const std::filesystem::path& file);

} // namespace reradiant
