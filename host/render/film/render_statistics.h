#pragma once

#include "reradiant/device.h"
#include "reradiant/render.h"

#include <nlohmann/json.hpp>

#include <string>

namespace reradiant {

/// Attribute of an image: digest of what made it (render_identity.h).
inline constexpr const char* render_identity_attribute = "reradiant:renderIdentity";

/// Returns what `render --json` writes: how a render went. `model` is the one that was asked for.
nlohmann::ordered_json render_statistics(const RenderResult& result, const Device& device,
                                         const std::string& model);

/// Gives the image the attributes that say what made it; `command_line` is the program's, or what
/// else asked for the render.
void describe_image(RenderResult& result, const Scene& scene, const Device& device,
                    const RenderOptions& options, const std::string& command_line);

} // namespace reradiant
