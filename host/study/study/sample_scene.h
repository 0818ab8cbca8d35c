#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>

namespace reradiant {

/// Name of the sample's material in the scene below.
inline constexpr const char* sample_material = "sample";

/// The scene that a study of a material alone is rendered in: a flat square sample, seen from afar,
/// and a square lamp (D65) in its mirror direction that it reflects in its middle. `material_file`
/// holds one [material], and textures if it has any. Input Error at its place.
toml::table sample_scene(const std::filesystem::path& material_file, int width, int height);

/// Tilts the sample from the direction of view, and moves the lamp to where it is mirrored.
/// 0 <= angle < 90 degrees.
void set_sample_angle(toml::table& scene, double angle_deg);

} // namespace reradiant
