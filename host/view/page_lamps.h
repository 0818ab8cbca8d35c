#pragma once

#include "host/spectral/colour/lamp.h"

#include <nlohmann/json.hpp>

#include <vector>

namespace reradiant {

/// The lamps of a page's lists, with means over cells of 1 nm (host/view/page/spectra.js): those
/// that are given, then usual ones that are not among them.
nlohmann::ordered_json lamps_json(const std::vector<Lamp>& lamps);

} // namespace reradiant
