#pragma once

#include "host/study/study/study.h"

namespace reradiant {

/// Exposure, EV, that all pictures of a study are shown at: what the study's file says, else one
/// chosen by the bodies. The brightest body is that of the picture whose median (of the largest
/// channel of linear sRGB, over pixels that are not black) is largest, so that highlights that
/// cover less than half of a sample do not count. 0 where it lies between a tenth and 0.9 of white
/// as it is; else it is shown at 0.6 of white. Reads every image.
double sheet_exposure_ev(const Study& study, const StudyResult& result);

} // namespace reradiant
