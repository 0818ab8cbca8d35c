#pragma once

#include "reradiant/wavelength_plan.h"

#include <string>

namespace reradiant {

/// comb[:N] (without N one wavelength a film band) or hero[:N]; std::invalid_argument says what
/// would be right.
WavelengthOptions wavelengths_from_text(const std::string& text);

} // namespace reradiant
