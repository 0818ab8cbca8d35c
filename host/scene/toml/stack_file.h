#pragma once

#include "host/layers/stack/stack.h"

#include <toml++/toml.h>

#include <filesystem>

namespace reradiant {

/// Reads the layers of a MATERIAL.toml, whose substrate may be anything or absent: the layers are
/// those that lay above a sample that was measured through them. Throws an input Error with the
/// place.
LayerStack load_stack(const std::filesystem::path& file);

/// Reads the layers from a table as `load_stack` does from a file. Paths in the table start at the
/// folder of `file`, which errors name.
LayerStack stack_from_table(const toml::table& table, const std::filesystem::path& file);

} // namespace reradiant
