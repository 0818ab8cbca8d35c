#pragma once

#include "reradiant/scene.h"

#include <nlohmann/json.hpp>

namespace reradiant {

/// Returns the parts of a material as JSON, for `info` and `validate`.
nlohmann::ordered_json describe_material(const Material& material);

/// Returns a description of every surface of a scene: what describe_material says of its material,
/// its textures, its count of variants (materials at levels of its textures) and its mixture. The
/// material of a textured surface is its first variant.
nlohmann::ordered_json describe_surfaces(const Scene& scene);

} // namespace reradiant
