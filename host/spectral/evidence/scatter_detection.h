#pragma once

#include "host/spectral/evidence/scatter_contrast.h"
#include "host/spectral/evidence/scatter_line.h"
#include "reradiant/reradiation.h"
#include "reradiant/scatter_line.h"

#include <vector>

namespace reradiant {

/// Lines that stand out of a measured matrix; NaN: not measured. Entries on a line are compared
/// with their neighbours across it (ScatterContrast), and so are those beside it. An excitation
/// shows the line when its entry stands out by five standard deviations of those beside, and by
/// half more than the largest of them. A third of the excitations must show it, two at least (half
/// and three beside the diagonal), and over four times its half width: what a fluorophore emits
/// does not move with the excitation, so that it looks like a line at a few excitations only. The
/// half width ends where nothing stands out any more. Half order, which lies below the excitation,
/// is looked for with `anti_stokes` only.
std::vector<FoundScatter> find_scatter(const ReradiationMatrix& matrix,
                                       const ScatterSettings& settings);

} // namespace reradiant
