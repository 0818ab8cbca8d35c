#pragma once

#include <toml++/toml.h>

#include <filesystem>

namespace reradiant {

/// True when a file is a scene of Mitsuba by its ending, .xml.
bool is_mitsuba_scene(const std::filesystem::path& file);

/// The scene of a Mitsuba 3 XML file as a scene table; file names in it start at `base`. Input
/// Error with line and column for whatever is not supported. What changes nothing or little (a
/// pixel filter, a sample count) is left out with a warning.
toml::table mitsuba_scene_table(const std::filesystem::path& file,
                                const std::filesystem::path& base);

} // namespace reradiant
