#pragma once

#include "reradiant/scene.h"

#include <toml++/toml.h>

#include <filesystem>

namespace reradiant {

/// Reads a scene from a table that was parsed from `file` and may have been changed since, as a
/// study does. Paths start at the file's folder, errors name the file (what was changed has no line
/// of its own), the hash is that of the table as it is now and of the files that it names.
Scene scene_from_table(const toml::table& table, const std::filesystem::path& file);

/// Reads a material from such a table, as load_material does from a file.
Material material_from_table(const toml::table& table, const std::filesystem::path& file);

/// Reads the table of a scene or material file and checks nothing but its syntax.
toml::table read_scene_table(const std::filesystem::path& file);

} // namespace reradiant
