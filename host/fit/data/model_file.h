#pragma once

#include "host/fit/result/fit.h"

#include <filesystem>

namespace reradiant {

/// Writes the fitted model as TOML: a [material] over a Lambertian substrate whose RERADIATION
/// holds one fluorophore a term (tables of its curves at the data's bands, whatever functions made
/// them) and the diagonal as reflectance. A `matrix` is named as a file: `matrix_file` (as written
/// beside it). Returns the largest difference between an entry that the scene's own integration
/// gives and the fitted one, relative to the largest entry; 0 for a `matrix`. Atomic.
double write_model_file(const std::filesystem::path& file, const FitResult& result,
                        const std::filesystem::path& matrix_file);

} // namespace reradiant
