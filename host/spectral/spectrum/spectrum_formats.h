#pragma once

#include "host/spectral/text/number_table.h"

#include <filesystem>

namespace reradiant {

/// Spectra of other programs and instruments as tables of (nm, value), ascending. All of them throw
/// an input Error with the place for what they do not understand; nothing is skipped but what the
/// format says is a remark.

/// JCAMP-DX 4.24 and 5.00 (McDonald and Wilks 1988) in the AFFN forms (X++(Y..Y)) and (XY..XY),
/// with XFACTOR and YFACTOR, of one REFLECTANCE or TRANSMITTANCE over NANOMETERS, MICROMETERS or
/// 1/CM.
NumberTable read_jcamp(const std::filesystem::path& file);

/// CGATS.17 text and Argyll's .sp with one sample: SPECTRAL_NM400 and its spellings, or
/// SPECTRAL_NM with SPECTRAL_DEC or SPECTRAL_PCT.
NumberTable read_cgats(const std::filesystem::path& file);

/// IES TM-27-14 (.spdx): the SpectralData of one SpectralDistribution.
NumberTable read_tm27(const std::filesystem::path& file);

/// A spectrum of any format that the file says it is of, whatever its ending.
NumberTable read_spectrum_table(const std::filesystem::path& file);

} // namespace reradiant
