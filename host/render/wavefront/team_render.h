#pragma once

#include "host/base/team.h"
#include "reradiant/render.h"

namespace reradiant {

/// Renders a scene together with the other members of a team, each with a device of its own: what
/// render() gives, within rounding, at the leader. Every member calls it with the same scene and
/// options; a different one is an input Error. Members render ranges of samples that the leader
/// hands out, and bring their films together whenever a checkpoint is due, when the error is to be
/// estimated, and at the end; only the leader reads and writes the checkpoint, which is that of
/// render(), and calls `observe`. `progress` is called by all; where one of them returns false, all
/// stop. The result of the others holds no image.
RenderResult render_together(const Scene& scene, const Device& device, const RenderOptions& options,
                             Team& team,
                             const std::function<bool(const RenderProgress&)>& progress = {},
                             const RenderObserver& observe = {});

} // namespace reradiant
