#pragma once

#include "reradiant/error.h"
#include "reradiant/spectral_files.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace reradiant {

/// A wavelength of an axis, with its place in the file.
struct PlacedWavelength {
    double nm = 0.0;
    SourcePosition position;
    double rounding_nm = 0.0; ///< half the last digit that the file writes
};

/// Half of one in the last digit of a number as it is written: 0.005 for "383.33".
double half_last_digit(std::string_view number);

/// Sorts an axis by wavelength and returns the order that its values must be taken in; input Error
/// at a wavelength that is given twice.
std::vector<int> sort_axis(std::vector<PlacedWavelength>& axis, const char* axis_name);

/// Grid of a sorted axis; input Error at the first wavelength that does not ascend in steps that
/// are equal within its rounding (the finest of the axis). `step_of_single_nm` is the width of an
/// axis of one band.
WavelengthGrid axis_grid(const std::vector<PlacedWavelength>& axis, const char* axis_name,
                         double step_of_single_nm);

/// Input Error unless a matrix of this size is small enough to hold (2^22 entries).
void require_matrix_size(const SourcePosition& position, std::size_t rows, std::size_t columns);

/// Multiplies every entry off the diagonal: the diagonal is a reflectance in every form.
void scale_off_diagonal(ReradiationMatrix& matrix, double factor);

/// Input Error at the file for a model with an entry below its excitation and no leave for it.
void refuse_undeclared_anti_stokes(const ReradiationMatrix& matrix, const SourcePosition& position);

/// Returns the place where a table says that it is a re-radiation CSV: in a line `# reradiation`,
/// by its quantity or orientation, or by the headings of the long form or of three wavelengths.
/// Empty for a spectrum.
std::optional<SourcePosition> declares_reradiation(const std::filesystem::path& file);
ReradiationMatrix read_matrix_csv(const std::filesystem::path& file, Gaps gaps = Gaps::Refused,
                                  const TableForm& form = {});
ReradiationMatrix read_matrix_bfc(const std::filesystem::path& file);
ReradiationMatrix read_matrix_exr(const std::filesystem::path& file);
void write_matrix_bfc(const std::filesystem::path& file, const ReradiationMatrix& matrix);
void write_matrix_exr(const std::filesystem::path& file, const ReradiationMatrix& matrix);

} // namespace reradiant
