#pragma once

#include "host/layers/rough/specular_lobes.h"

#include <Eigen/Core>

#include <memory>

namespace reradiant {

/// Light between the facets of an opaque rough surface that reflect everything, by how often it met
/// them before it left: (CosineTable::nodes, orders), column k is the share that met k + 2; the
/// last one holds all that met more often too. With the lobe's own albedo (one meeting) a row adds
/// up to
/// 1. From walks on the Smith microsurface (Heitz et al. 2016), ggx and beckmann; good to 1 % of
/// itself. Kept, thread-safe.
std::shared_ptr<const Eigen::MatrixXd> facet_orders(const AddingTransport::Lobe& lobe);

} // namespace reradiant
