#pragma once

#include "host/layers/rough/specular_lobes.h"
#include "reradiant/stack_elements.h"

#include <memory>
#include <span>

namespace reradiant {

/// The lobe of light that goes through a sheet with rough faces without being scattered in slabs,
/// as seen from either side. It is the lobe of facets over the half vector of one direction and the
/// mirror image of the other, as wide as the faces spread light (kernels/scatter/lobe_width.h),
/// times a tabulated ratio (kernels/scatter/lobe_ratio.h).
struct ThroughLobe {
    LobeShape above, below;
};

/// Returns the lobe of a sheet in air that stands for all bands of it; null where all of its faces
/// are smooth. Its shape is that at the band which absorbs least, scattering left out. Thread-safe.
///
/// Ratios (host/layers/models/lobe_ratios.h) are made by walks between the faces of a sheet nearby,
/// from the smoother one to the rougher one, whose facets are connected to all directions whenever
/// light meets them; they hold all light that goes back and forth. Who uses a lobe scales it to the
/// flux that it must carry.
std::shared_ptr<const ThroughLobe> through_lobe(std::span<const StackElements> bands);

} // namespace reradiant
