#pragma once

#include "host/film/region_values.h"

#include <string>
#include <vector>

namespace reradiant {

/// Places that a command line names: each `--at X,Y[:R]` (a pixel, or those within R pixels of it),
/// then each `--region X0,Y0,X1,Y1` (both corners belong to it). Input Error that names the option
/// for what is no such text, for corners in the wrong order, for a place given twice, and for none.
std::vector<ImageRegion> probe_places(const std::vector<std::string>& at,
                                      const std::vector<std::string>& regions);

} // namespace reradiant
