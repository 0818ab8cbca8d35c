#pragma once

#include "host/layers/rough/specular_lobes.h"

#include <Eigen/Core>

#include <memory>

namespace reradiant {

/// Returns how light between the facets of an opaque rough surface that reflect everything divides
/// by the number of facets that it met before it left: (CosineTable::nodes, orders), where column k
/// is the share that met k + 2 and the last column also holds all that met more. Together with the
/// lobe's own albedo (one meeting) a row adds up to 1. The shares come from walks on the Smith
/// microsurface (Heitz et al. 2016) for ggx and beckmann, and have a relative error of about 1 %.
/// Results are kept for later calls; thread-safe.
std::shared_ptr<const Eigen::MatrixXd> facet_orders(const LobeShape& lobe);

} // namespace reradiant
