#pragma once

#include "host/study/converge/converge.h"

namespace reradiant {

/// Refuses a model that some material cannot be rendered by. The coarsest comb does for that.
void check_methods(const Scene& scene, const ConvergeOptions& options);

/// Returns true when an image has the size and the bands of the scene's film.
bool is_of_film(const SpectralImage& image, const Scene& scene, const WavelengthGrid& bands);

/// Refuses a reference of another size or other bands than the scene's film.
void check_reference(const Reference& reference, const Scene& scene, const WavelengthGrid& bands);

} // namespace reradiant
