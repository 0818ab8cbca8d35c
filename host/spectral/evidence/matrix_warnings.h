#pragma once

#include "reradiant/reradiation.h"

#include <string>
#include <vector>

namespace reradiant {

/// Sentences on what speaks against reading a matrix as it was read, each with the likely cause and
/// its remedy: rows and columns exchanged, values per nm taken as values per band or the reverse,
/// fractions divided by 100 once more. Nothing of anti-Stokes emission that the matrix declares.
std::vector<std::string> misreading_warnings(const ReradiationMatrix& matrix);

/// Returns a sentence where excitation bands return more photons than they receive; else an empty
/// text.
std::string photon_warning(const std::vector<double>& photons, const WavelengthGrid& excitation);

/// misreading_warnings, and where there are none, excitation bands that return more energy or
/// photons than they receive. Gaps (NaN) count as 0.
std::vector<std::string> matrix_warnings(const ReradiationMatrix& matrix);

/// Logs matrix_warnings as warnings, each behind the name of what was read.
void warn_of_matrix(const std::string& name, const ReradiationMatrix& matrix);

} // namespace reradiant
