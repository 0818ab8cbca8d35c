#pragma once

#include "host/scene/mitsuba/mitsuba_object.h"

#include <toml++/toml.h>

#include <map>
#include <set>
#include <string>

namespace reradiant {

/// A `MitsubaScene` is what the parts of an import share: the scene that is made, and how files are
/// named in it.
class MitsubaScene {
public:
    /// File names in the table start at `base`.
    MitsubaScene(const MitsubaDocument& document, std::filesystem::path base)
        : document_(document), base_(std::move(base)) {}

    const MitsubaDocument& document() const { return document_; }
    /// The file that a <string name="filename"> names, as the table says it; input Error at the
    /// element when it does not exist.
    std::string file_name(const MitsubaObject& owner, const std::string& property) const;
    std::string file_name(const pugi::xml_node& element, const std::string& given) const;

    /// Keys that have no place yet get that of `element` in both.
    void add(const char* list, toml::table entry, const pugi::xml_node& element);
    void set(const char* key, toml::table entry, const pugi::xml_node& element);
    /// A name like the given one that no other entry of the list has.
    std::string unique_name(const std::string& wanted);
    toml::table& table() { return table_; }

    /// Names of materials by the offset of their <bsdf>: each is added once.
    std::map<std::ptrdiff_t, std::string> material_names;
    std::set<std::ptrdiff_t> nested_bsdfs; ///< offsets of those that others hold
    int bsdf_depth = 0;                    ///< nesting depth of the one that is read now
    /// Type of the last texture that was read, and of a texture that a material uses ("image",
    /// "checker"); empty: none.
    std::string texture_met;
    std::map<std::string, std::string> material_textures;

private:
    const MitsubaDocument& document_;
    std::filesystem::path base_;
    toml::table table_;
    std::map<std::string, int> names_;
};

toml::array toml_vector(const Eigen::Vector3d& v);

/// A spectrum, as scene files of this program write it, from a property in any of Mitsuba's forms.
/// Emission: <float> and <rgb> are multiples of D65, as Mitsuba has them in its spectral modes.
toml::table mitsuba_emission(const MitsubaObject& owner, const std::string& name,
                             MitsubaScene& scene);
/// Inserts a reflectance or the like, also a texture, from a property: a number, table or reference
/// at `key`. `otherwise` is inserted when the property is absent.
void insert_mitsuba_reflectance(toml::table& into, const char* key, const MitsubaObject& owner,
                                const std::string& name, double otherwise, MitsubaScene& scene);
/// Inserts an IOR or an absorption, as `insert_mitsuba_reflectance` does for a reflectance, but
/// without textures and colours.
void insert_mitsuba_spectrum(toml::table& into, const char* key, const MitsubaObject& owner,
                             const std::string& name, MitsubaScene& scene);

/// Makes a base beneath a coat look as in Mitsuba's plastic without `nonlinear`, which treats every
/// reflection between the two as one by a white base: Mitsuba divides rho by 1 - r, this program by
/// 1 - r rho, so the base gets rho / (1 - r + r rho). Returns false and changes nothing for a
/// texture.
bool take_linear_plastic(toml::table& substrate, const toml::table& layer);

/// Makes a [[texture]] of a texture plugin and returns what a reflectance says to use it.
toml::table mitsuba_texture(const pugi::xml_node& element, MitsubaScene& scene);

/// Adds the material of a <bsdf> once, and returns its name.
std::string mitsuba_material(const pugi::xml_node& element, MitsubaScene& scene);
std::string mitsuba_default_material(MitsubaScene& scene);

/// Shapes with their emitters, emitters of their own, and sensor, film, integrator.
void add_mitsuba_shape(const pugi::xml_node& element, MitsubaScene& scene);
void add_mitsuba_emitter(const pugi::xml_node& element, MitsubaScene& scene);
void add_mitsuba_sensor(const pugi::xml_node& element, MitsubaScene& scene);
void add_mitsuba_integrator(const pugi::xml_node& element, MitsubaScene& scene);

} // namespace reradiant
