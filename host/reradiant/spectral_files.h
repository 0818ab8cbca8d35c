#pragma once

#include "reradiant/reradiation.h"
#include "reradiant/spectrum.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// Reads a spectrum by what the file says it is, whatever its ending: JCAMP-DX, CGATS, IES TM-27
/// (spectrum_formats.h), else a table of two columns (number_table.h).
Spectrum read_spectrum(const std::filesystem::path& file);
void write_spectrum(const std::filesystem::path& file, const std::vector<double>& wavelengths_nm,
                    const std::vector<double>& values);

/// A `DecimalMark` is the sign that parts the whole from the fraction in a table's numbers.
enum class DecimalMark { Automatic, Comma, Point };

/// A `TableForm` is what the reader of a plain table of numbers is told, since the table does not
/// say it. Where it does, the two must agree.
struct TableForm {
    std::optional<MatrixQuantity> quantity;
    std::optional<bool> rows_are_emission;
    std::optional<double> scale; ///< values are multiplied by it: 0.01 for percent
    std::optional<MatrixKind> kind;
    bool anti_stokes_allowed = false;
    std::optional<std::string> geometry; ///< illumination/viewing, as in 45/0
    DecimalMark decimal = DecimalMark::Automatic;

    bool operator==(const TableForm&) const = default;
};

/// `TableWords` holds a TableForm in a user's words; empty ones say nothing.
struct TableWords {
    std::string rows = {};     ///< emission, excitation (or rows-emission, rows-excitation)
    std::string quantity = {}; ///< per-band, density (or density-per-nm)
    std::string scale = {};    ///< percent, permille or a factor above 0
    std::string decimal = {};  ///< comma, point
    std::string kind = {};     ///< measured, model
    bool anti_stokes = false;
    std::string geometry = {}; ///< 45/0, 8/d and so on
};

/// Returns the form that the words stand for; input Error for other words.
TableForm table_form(const TableWords& words);
/// True for rows = emission; input Error for a word that is none of rows.
bool rows_are_emission(const std::string& rows);
/// Returns the quantity that a word stands for; input Error for a word that is none.
MatrixQuantity matrix_quantity(const std::string& quantity);

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
