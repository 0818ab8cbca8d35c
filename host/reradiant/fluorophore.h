#pragma once

#include "reradiant/spectrum.h"

namespace reradiant {

/// One fluorophore: F(lo, li) = Q x(li) li e(lo) / integral over lo > li of e(l) l dl, zero for
/// lo <= li.
struct Fluorophore {
    Spectrum excitation; ///< x: fraction of incident photons absorbed, 0..1
    Spectrum emission;   ///< e: relative radiant power per nm
    double quantum_yield = 1.0;
};

} // namespace reradiant
