#pragma once

#include "host/scene/load_state.h"
#include "host/scene/table_reader.h"

namespace reradiant {

/// A [material] or [[material]] table (INTERFACE). `preset = "x"` reads spectra/materials/x.toml,
/// which may not be a preset in its turn.
enum class MaterialPlace { Scene, MaterialFile, PresetFile };
Material read_material(const toml::table& table, const std::string& file, MaterialPlace place,
                       LoadState& state);

/// RERADIATION (INTERFACE) at a key: fills matrix or fluorophores, and the reflectance. A matrix
/// that breaks energy is refused at the key; what was repaired or breaks the photon balance is
/// logged as a warning.
void read_reradiation_key(const TableReader& table, const std::string& key, Substrate& substrate,
                          LoadState& state);

/// Wavelengths at which a scene or material with no `bands_nm` is used (DESIGN 1).
std::array<double, 2> default_range_nm(bool fluorescent);

} // namespace reradiant
