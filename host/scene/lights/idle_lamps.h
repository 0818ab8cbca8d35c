#pragma once

#include "reradiant/scene.h"

#include <string>

namespace reradiant {

/// Says why a light of a scene lights nothing in its picture: it is black, or has no light within
/// the film's bands and what excites the materials, or faces away from every shape and the camera.
/// Empty where it may light something.
std::string idle_reason(const Light& light, const Scene& scene);

} // namespace reradiant
