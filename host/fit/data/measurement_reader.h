#pragma once

#include "reradiant/bispectral_data.h"
#include "reradiant/spectral_files.h"

namespace reradiant {

/// Whose light a fit takes: of a measurement of `measure` the diffuse rows, or those of slabs too.
enum class MeasuredLight {
    OfSubstrate, ///< refuses light that dyes in slabs sent out, on one side
    OfAll        ///< what slabs and substrate sent out, on both sides of a sheet
};

/// Reads the CSV of `measure` as one block a geometry, value = pi times the BRRDF of its diffuse
/// rows, and with OfAll of those of slabs; entries without a row are NaN, a standard error of 0 is
/// unknown. Refuses hemispherical rows and repeated ones. Input Error with the place.
BispectralData read_measurement_blocks(const std::filesystem::path& file,
                                       MeasuredLight light = MeasuredLight::OfSubstrate);

/// Reads what read_bispectral_data does without judging whether the values are plausible.
BispectralData read_unjudged_data(const std::filesystem::path& file, const TableForm& form,
                                  MeasuredLight light);

} // namespace reradiant
