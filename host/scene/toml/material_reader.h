#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

#include <array>

namespace reradiant {

/// A `MaterialReading` is the content of a [material] or [[material]] table: a material, or one per
/// combination of texture levels, and what a Surface holds besides.
struct MaterialReading {
    Material
        representative; ///< every texture at t = 1/2; the material itself when nothing is textured
    std::vector<Material> variants; ///< the last texture runs fastest; empty when not textured
    std::vector<int> textures;      ///< into LoadState::textures, as are the other two
    int normal_texture = -1;
    std::string mixed_with; ///< empty: no mixture
    SourcePosition mixed_with_position;
    double mix_weight = 0.0;
    int mix_texture = -1;
    std::array<double, 2> opacity{1.0, 1.0}; ///< Surface
    int opacity_texture = -1;
};

/// `preset = "x"` reads spectra/materials/x.toml, and `preset = "x.toml"` a material file beside
/// this one; neither may be a preset in its turn. Other keys of the material are laid over what
/// stands there (lay_over). state.texture_scope must hold the textures of the file.
enum class MaterialPlace { Scene, MaterialFile, PresetFile };
MaterialReading read_material(const toml::table& table, const std::string& file,
                              MaterialPlace place, LoadState& state);
/// A preset by name; input Error at `at` when there is none.
MaterialReading read_preset(const std::string& preset, const SourcePosition& at, LoadState& state);

/// The [material.substrate] of a material.
Substrate read_substrate(const TableReader& material, LoadState& state);

/// Fluorophores of one substrate or layer.
inline constexpr std::size_t MAX_FLUOROPHORES = 64;

/// Reads the re-radiation matrix that `file` of a table names. One that breaks energy is refused at
/// the key; what was repaired or breaks the photon balance is logged as a warning.
ReradiationMatrix read_matrix_file(const TableReader& reader, LoadState& state);

/// Reads the re-radiation at a key: fills matrix or fluorophores, and the reflectance. A matrix
/// that breaks energy is refused at the key; what was repaired or breaks the photon balance is
/// logged as a warning.
void read_reradiation_key(const TableReader& table, const std::string& key, Substrate& substrate,
                          LoadState& state);

/// Returns the range of wavelengths at which a scene or material without `bands_nm` is used.
std::array<double, 2> default_range_nm(bool fluorescent);

} // namespace reradiant
