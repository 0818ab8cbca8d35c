#pragma once

#include "host/layers/stack/stack.h"

#include <toml++/toml.h>

#include <filesystem>

namespace reradiant {

/// The layers of a MATERIAL.toml, whose substrate may be anything or absent: what lay above a
/// sample that was measured through them. Input Error with the place.
LayerStack load_stack(const std::filesystem::path& file);

/// The same from a table; paths in it start at the file's folder, errors name the file.
LayerStack stack_from_table(const toml::table& table, const std::filesystem::path& file);

} // namespace reradiant
