#pragma once

#include "reradiant/reradiation.h"

#include <string>
#include <vector>

namespace reradiant {

/// A sentence a line of scatter that stands out of a measurement used as it is, for renderings and
/// colours, whose light it adds to; nothing for a model. The band beside the diagonal is not looked
/// at.
std::vector<std::string> scatter_warnings(const ReradiationMatrix& matrix);

} // namespace reradiant
