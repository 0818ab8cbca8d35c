#pragma once

#include "host/study/study/study_file.h"

namespace reradiant {

/// The scene of a cell, or of one sweep's value alone: the study's base with these values. Input
/// Error, at the value in the study where that is known, when they make no valid scene.
struct ChosenValue {
    const Sweep* sweep;
    const SweepValue* value;
};
Scene scene_with(const Study& study, const std::vector<ChosenValue>& values);

} // namespace reradiant
