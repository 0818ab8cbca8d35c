#pragma once

#include "reradiant/layer_stack.h"

#include <toml++/toml.h>

#include <filesystem>

namespace reradiant {

/// Reads the layers from a table as `load_stack` does from a file. Paths in the table start at the
/// folder of `file`, which errors name.
LayerStack stack_from_table(const toml::table& table, const std::filesystem::path& file);

} // namespace reradiant
