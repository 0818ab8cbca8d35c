#pragma once

#include "reradiant/reradiation.h"

#include <Eigen/Core>

#include <filesystem>

namespace reradiant {

/// The functions below refuse what can only be explained by another unit than nm or 1. Each throws
/// an input Error with the place in the file, which may be a name only where the values never were
/// in one.

/// Refuses wavelengths below 100 nm or above 3000 nm.
void require_plausible_bands(const WavelengthGrid& emission, const WavelengthGrid& excitation,
                             const std::filesystem::path& file);

/// Refuses radiance factors above 10 in one band (NaN is a gap): percent or counts. Totals of 2.4
/// over all excitation have been measured.
void require_plausible_values(const Eigen::MatrixXd& values, const std::filesystem::path& file);

/// Refuses both, and where the energy that an excitation band typically returns (the median over
/// the bands, since one may hold an outlier) is above twice what it receives: percent of a dark
/// sample.
void require_plausible_matrix(const ReradiationMatrix& matrix, const std::filesystem::path& file);

} // namespace reradiant
