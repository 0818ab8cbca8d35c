#pragma once

#include "reradiant/merge.h"
#include "reradiant/scene.h"
#include "reradiant/wavelength_grid.h"
#include "reradiant/wavelength_plan.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace reradiant {

/// Texts of options that several commands share. Each throws an input Error that names the option
/// and says what would be right.

/// --bands FROM:TO:STEP, centres in nm.
WavelengthGrid parse_bands_option(const std::string& text);
/// --model auto|adding|weidlich-wilkie|walk
Model parse_model_option(const std::string& text);
/// --wavelengths comb[:N] (without N one wavelength a film band) or hero[:N]
WavelengthOptions parse_wavelengths_option(const std::string& text);

/// --sample-range A:B with A < B
SampleRange parse_sample_range_option(const std::string& text);

/// --preset NAME: the material's file.
std::filesystem::path preset_file(const std::string& name);

} // namespace reradiant
