#pragma once

#include "reradiant/bispectral_data.h"

namespace reradiant {

/// Reads the CSV of `measure` as one block a geometry, value = pi times the BRRDF of its diffuse
/// rows; entries without a row are NaN, a standard error of 0 is unknown. Refuses hemispherical
/// rows and repeated ones. Input Error with the place.
BispectralData read_measurement_blocks(const std::filesystem::path& file);

} // namespace reradiant
