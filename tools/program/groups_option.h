#pragma once

#include "reradiant/spectral_image.h"
#include "tools/program/command_line.h"

#include <filesystem>
#include <string>

namespace reradiant {

/// --groups of every command that reads an image whose lights it may turn up or down.
void add_groups_option(Command& command, std::string& text);

/// --groups NAME=FACTOR,... with factors that are not negative; empty for an empty text. Input
/// Error that names the option.
LightFactors parse_groups_option(const std::string& text);

/// Reads a spectral image, with its lights as the factors say where there are any.
SpectralImage read_image(const std::filesystem::path& file, const LightFactors& factors);

} // namespace reradiant
