#pragma once

#include "reradiant/scene.h"

namespace reradiant {

/// Joins neighbouring layers of one medium in every material of a scene (join_layers of
/// host/layers/stack/joined_layers.h); those of one surface at the levels of its textures keep
/// equally many layers.
void join_layers(Scene& scene);
/// The same of a material that stands for itself.
void join_layers(Material& material);

} // namespace reradiant
