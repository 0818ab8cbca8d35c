#pragma once

#include "reradiant/scene.h"

#include <nlohmann/json.hpp>

namespace reradiant {

/// What a material holds, for `info` and `validate`.
nlohmann::ordered_json describe_material(const Material& material);

/// The same of every surface of a scene, with its textures, its count of variants (materials at
/// levels of its textures) and its mixture; the material of a textured one is its first variant.
nlohmann::ordered_json describe_surfaces(const Scene& scene);

} // namespace reradiant
