#pragma once

#include "reradiant/scene.h"

#include <toml++/toml.h>

#include <filesystem>
#include <optional>

namespace reradiant {

/// Reads a scene from a table that was parsed from `file` and may have been changed since, as a
/// study does. Paths start at the file's folder, errors name the file (what was changed has no line
/// of its own), the hash is that of the table as it is now and of the files that it names.
Scene scene_from_table(const toml::table& table, const std::filesystem::path& file);

/// Reads a scene in which every material has the layers that are written, for what counts them:
/// join_layers (host/scene/model/joined_materials.h) makes of it what scene_from_table gives.
Scene scene_as_written(const toml::table& table, const std::filesystem::path& file);

/// Reads a material from such a table, as load_material does from a file.
Material material_from_table(const toml::table& table, const std::filesystem::path& file,
                             const std::optional<WavelengthGrid>& bands = {});

/// Reads the table of a scene or material file and checks nothing but its syntax.
toml::table read_scene_table(const std::filesystem::path& file);

} // namespace reradiant
