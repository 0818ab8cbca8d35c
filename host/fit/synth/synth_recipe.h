#pragma once

#include "reradiant/synth.h"

#include <toml++/toml.h>

namespace reradiant {

/// read_synth_recipe from a table; paths in it start at the file's folder, errors name the file.
SynthRecipe synth_recipe_from_table(const toml::table& table, const std::filesystem::path& file);

} // namespace reradiant
