#pragma once

#include "reradiant/layer_stack.h"

#include <toml++/toml.h>

#include <filesystem>

namespace reradiant {

/// The layers of a table of MATERIAL.toml, as load_stack reads them from a file; paths in it start
/// at the file's folder, errors name the file.
LayerStack stack_from_table(const toml::table& table, const std::filesystem::path& file);

} // namespace reradiant
