#pragma once

#include "host/spectral/colour/lamp.h"

#include <filesystem>

namespace reradiant {

/// Reads a lamp: `spectrum` of a TOML file, in any form that scenes know (a product with a filter,
/// say), or else any file of a spectrum (read_lamp). Input Error as there and as in scenes.
Lamp read_lamp_file(const std::filesystem::path& file);

} // namespace reradiant
