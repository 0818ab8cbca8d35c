#pragma once

#include "reradiant/scene.h"

namespace reradiant::fuzz {

/// Fails when a number of what a reader returned is not finite.
void check_spectrum(const Spectrum& spectrum);
void check_stack(const LayerStack& stack);
void check_material(const Material& material);
void check_scene(const Scene& scene);

/// Writes what the inputs of the text targets may name: a matrix, a mesh and an image.
void put_companions();

} // namespace reradiant::fuzz
