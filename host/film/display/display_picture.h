#pragma once

#include "host/film/display/develop.h"

namespace reradiant {

/// Input Error for a configuration, display or view that no image can be shown through, with the
/// names that there are.
void check_display(const DisplayOptions& options);
/// Input Error for an exposure that is no number or beyond 100 EV to either side.
void check_exposure(double exposure_ev);

/// What write_display_png writes.
Picture display_picture(const SpectralImage& image, const DisplayOptions& options);

} // namespace reradiant
