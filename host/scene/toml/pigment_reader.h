#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

namespace reradiant {

/// The keys of a diffuse substrate made of pigments: `pigments`, `dyes`, `thickness`, `backing`.
const std::vector<std::string>& pigment_keys();

/// True when the substrate is one of pigments or dyes, or has a key that only they have.
bool has_pigments(const TableReader& substrate);

/// Reads the pigments and sets reflectance and, with a dye that emits, matrix
/// (host/spectral/matrix/kubelka_munk.h; 300 to 780 nm by 5 nm).
void read_pigments(const TableReader& reader, Substrate& substrate, LoadState& state);

} // namespace reradiant
