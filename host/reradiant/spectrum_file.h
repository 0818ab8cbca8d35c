#pragma once

#include "reradiant/spectrum.h"

#include <filesystem>
#include <vector>

namespace reradiant {

/// Reads a spectrum by what the file says it is, whatever its ending: JCAMP-DX, CGATS, IES TM-27
/// (spectrum_formats.h), else a table of two columns (number_table.h).
Spectrum read_spectrum(const std::filesystem::path& file);
void write_spectrum(const std::filesystem::path& file, const std::vector<double>& wavelengths_nm,
                    const std::vector<double>& values);

} // namespace reradiant
