#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

namespace reradiant {

inline constexpr double MAX_IOR = 100.0;

/// A [[material.layer]] table: an interface, its film, the slab beneath it, the slab's dyes and
/// flakes.
Layer read_layer(const toml::table& table, const std::string& file, std::size_t index,
                 LoadState& state);

/// The [material.back] of a sheet, its lower face, which is smooth where the table is absent.
LowerFace read_lower_face(const TableReader& material, LoadState& state);

/// The keys of a conductor: `ior` and `kappa`, or `metal` (a table of spectra/metals by name);
/// its surface and its film.
const std::vector<std::string>& conductor_keys();
Conductor read_conductor(const TableReader& reader, LoadState& state);

/// Names that `metal = "..."` takes, sorted: the files of spectra/metals.
std::vector<std::string> metal_names();

} // namespace reradiant
