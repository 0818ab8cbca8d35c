#include "host/study/study/sweep_apply.h"

#include "host/scene/document/table_reader.h"
#include "host/scene/model/dye_concentration.h"
#include "host/scene/model/joined_materials.h"
#include "host/scene/toml/scene_table.h"
#include "host/study/study/sample_scene.h"
#include "host/study/study/toml_path.h"
#include "reradiant/colour.h"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr double most_of_dye = 1e9; // times the file's; optical depths stay finite

bool is_meant(int wanted, std::size_t index) {
    return wanted < 0 || static_cast<std::size_t>(wanted) == index;
}

/// The key that holds a light's spectrum.
std::string spectrum_key(const toml::table& light) {
    for (const char* key : {"intensity", "irradiance"})
        if (light.contains(key))
            return key;
    return "radiance";
}

Spectrum& spectrum_of(Light& light) {
    return const_cast<Spectrum&>(light_spectrum(light));
}

void set_lights(toml::table& scene, const ChosenValue& chosen) {
    toml::array& lights = *scene["light"].as_array();
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (toml::table* const light = lights[i].as_table();
            light != nullptr && is_meant(chosen.sweep->index, i))
            light->insert_or_assign(spectrum_key(*light), chosen.value->node());
}

void set_key(toml::table& scene, const ChosenValue& chosen) {
    // One word for roughness, and one for what a substrate reflects, excludes the other.
    static const std::map<std::string, std::string> excluded{{"roughness_deg", "alpha"},
                                                             {"alpha", "roughness_deg"},
                                                             {"reradiation", "reflectance"},
                                                             {"reflectance", "reradiation"}};
    const TomlPath& path = chosen.sweep->path;
    const toml::node& value = chosen.value->node();
    toml::node& parent = node_at(scene, path, path.size() - 1, chosen.value->position);
    if (toml::array* const array = parent.as_array()) {
        const std::size_t index = element_index(*array, path.back()).value();
        array->replace(array->begin() + static_cast<std::ptrdiff_t>(index), value);
        return;
    }
    toml::table& table = *parent.as_table();
    if (const auto other = excluded.find(path.back()); other != excluded.end())
        table.erase(other->second);
    if (chosen.sweep->kind == SweepKind::Matrix && value.is_string())
        table.insert_or_assign(path.back(), toml::table{{"file", *value.value<std::string>()}});
    else
        table.insert_or_assign(path.back(), value);
}

void apply_to_table(toml::table& scene, const ChosenValue& chosen) {
    switch (chosen.sweep->kind) {
    case SweepKind::Angle:
        set_sample_angle(scene, number_at(chosen.value->node(), chosen.value->position, "angle",
                                          {.low = 0.0, .high = 90.0, .high_is_allowed = false}));
        return;
    case SweepKind::Illuminant:
        if (!chosen.value->node().is_string())
            set_lights(scene, chosen);
        return;
    case SweepKind::Concentration:
        return;
    case SweepKind::Key:
    case SweepKind::Matrix:
        set_key(scene, chosen);
    }
}

/// Multiplies the concentrations of dyes in a layer by a factor.
void scale_dyes(Layer& layer, int index, double factor) {
    for (std::size_t k = 0; k < layer.dyes.size(); ++k)
        if (is_meant(index, k))
            layer.dyes[k].concentration *= factor;
}

void apply_concentration(Material& material, const Sweep& sweep, const SweepValue& value) {
    // What a substrate reflects without its dyes is not known where they absorb all light.
    const NumberRange range =
        sweep.layer < 0 ? NumberRange::above(0.0) : NumberRange::within(0.0, most_of_dye);
    const double factor = number_at(value.node(), value.position, "concentration", range);
    if (sweep.layer < 0)
        set_dye_concentration(material.substrate, sweep.index, factor);
    else
        scale_dyes(material.stack.layers.at(static_cast<std::size_t>(sweep.layer)), sweep.index,
                   factor);
}

/// An illuminant by name keeps the light's luminance.
void set_illuminant(Light& light, const SweepValue& value) {
    const std::string name = *value.node().value<std::string>();
    Spectrum& spectrum = spectrum_of(light);
    const double luminance = xyz_of(spectrum)[1];
    if (!(luminance > 0.0))
        throw_input_error(value.position, "the light has no luminance for the illuminant to keep",
                          fmt::format("write {{ illuminant = \"{}\", scale = ... }}", name));
    try {
        spectrum = illuminant_with_luminance(name, luminance);
    } catch (const std::invalid_argument& error) {
        throw_input_error(value.position, error.what());
    }
}

/// Applies what the tables have no words for: a concentration, and an illuminant by name.
void apply_to_scene(Scene& scene, const std::string& material, const ChosenValue& chosen) {
    const Sweep& sweep = *chosen.sweep;
    const SweepValue& value = *chosen.value;
    if (sweep.kind == SweepKind::Concentration)
        for (Material& one : scene.materials)
            if (one.name == material)
                apply_concentration(one, sweep, value);
    if (sweep.kind == SweepKind::Illuminant && value.node().is_string())
        for (std::size_t i = 0; i < scene.lights.size(); ++i)
            if (is_meant(sweep.index, i))
                set_illuminant(scene.lights[i], value);
}

} // namespace

Scene scene_with(const Study& study, const std::vector<ChosenValue>& values) {
    toml::table table = study.base;
    for (const ChosenValue& chosen : values)
        apply_to_table(table, chosen);
    Scene scene = scene_as_written(table, study.base_file);
    for (const ChosenValue& chosen : values)
        apply_to_scene(scene, study.material, chosen);
    join_layers(scene);
    return scene;
}

} // namespace reradiant
