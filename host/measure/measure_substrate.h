#pragma once

#include "host/layers/stack/substrate_values.h"
#include "reradiant/layer_stack.h"
#include "reradiant/measure.h"
#include "reradiant/scene.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

namespace reradiant {

/// Measures a stack over a diffuse substrate that is given by its per-band matrix, (bands, bands),
/// rows = emission. `request.bands` is not used.
Measurement measure_stack(const LayerStack& stack, const Eigen::MatrixXd& per_band,
                          const WavelengthGrid& bands, const MeasureRequest& request);

/// Measures a stack over any substrate. `request.bands` is not used.
Measurement measure_substrate(const LayerStack& stack, const SubstrateValues& substrate,
                              const WavelengthGrid& bands, const MeasureRequest& request);

/// A substrate at the band centres.
SubstrateValues measured_substrate(const Substrate& substrate, const WavelengthGrid& bands);

} // namespace reradiant
