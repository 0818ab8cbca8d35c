#pragma once

#include "reradiant/scene.h"

namespace reradiant {

/// Changes how much there is of a substrate's fluorophore (index -1: of all), times what there was.
/// More of a dye absorbs more, by Beer and Lambert: of a share x that was absorbed, (1 - x)^c
/// passes now, and of what passes the substrate reflects the same share as before.
void set_dye_concentration(Substrate& substrate, int index, double concentration);

} // namespace reradiant
