#include "host/study/study/sweep_target.h"

#include "host/study/study/toml_path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace reradiant {

namespace {

constexpr const char* every_element = "*";
constexpr int most_index = 1 << 20;

/// Keys of a layer that named parameters stand for.
const std::map<std::string, std::string> layer_keys{{"thickness", "thickness"},
                                                    {"absorption", "absorption"},
                                                    {"roughness", "roughness_deg"},
                                                    {"ior", "ior"}};
const std::vector<std::string> parameters{"angle", "thickness", "absorption",    "roughness",
                                          "ior",   "matrix",    "concentration", "illuminant"};

std::string element(int index) {
    return index < 0 ? every_element : std::to_string(index);
}

/// Returns the unit that numbers of a sweep are counted in. Thickness has a unit of the file's own,
/// which its absorption is per.
std::string unit_of(const Sweep& sweep) {
    static const std::map<std::string, std::string> units{
        {"angle", "deg"},
        {"sigma", "rad"},
        {"thickness", "units"},
        {"absorption", "per unit of thickness"},
        {"scattering_coefficient", "per unit of thickness"}};
    if (sweep.kind == SweepKind::Concentration)
        return "x the file's";
    const std::string& key = sweep.path.back();
    if (const auto known = units.find(key); known != units.end())
        return known->second;
    for (const auto& [ending, unit] : {std::pair{"_deg", "deg"}, {"_nm", "nm"}, {"_kelvin", "K"}})
        if (key.ends_with(ending))
            return unit;
    return {};
}

/// Refuses the keys that choose among layers, lights or fluorophores where there is no choice.
void refuse_choice(const TableReader& reader, const std::string& parameter) {
    const bool is_of_layer = layer_keys.contains(parameter) || parameter == "concentration";
    const std::pair<const char*, bool> choices[] = {{"layer", is_of_layer},
                                                    {"light", parameter == "illuminant"},
                                                    {"fluorophore", parameter == "concentration"}};
    for (const auto& [key, fits] : choices)
        if (reader.has(key) && !fits)
            reader.fail(key,
                        parameter.empty() ? fmt::format("a key says already which {} it is of", key)
                                          : fmt::format("{} is of no {}", parameter, key),
                        fmt::format("leave {} away", key));
}

void resolve_angle(const TableReader& reader, const Study& study, Sweep& sweep) {
    if (!study.is_sample)
        reader.fail("parameter", "a scene has no one angle",
                    "sweep key = \"camera.origin\", or study the material without a scene");
    sweep.kind = SweepKind::Angle;
    sweep.path = {"angle"};
}

void resolve_illuminant(const TableReader& reader, const Study& study, Sweep& sweep) {
    sweep.kind = SweepKind::Illuminant;
    sweep.index = reader.integer_or("light", -1, 0, most_index);
    sweep.path = {"light", element(sweep.index), "radiance"};
    node_at(study.base, sweep.path, sweep.index < 0 ? 1 : 2, sweep.position);
}

/// Returns the layer whose fluorophores are meant where none is named: the only one that holds some
/// in a material whose substrate holds none; -1: the substrate.
int layer_of_dyes(const TableReader& reader, const Study& study, const SourcePosition& at) {
    const toml::table& material =
        *node_at(study.base, {"material", study.material}, 2, at).as_table();
    const toml::array* const layers = material["layer"].as_array();
    if (layers == nullptr || material["substrate"]["reradiation"]["fluorophores"])
        return -1;
    std::vector<int> dyed;
    for (std::size_t k = 0; k < layers->size(); ++k)
        if (const toml::table* const layer = layers->get(k)->as_table();
            layer != nullptr && layer->contains("fluorophores"))
            dyed.push_back(static_cast<int>(k));
    if (dyed.size() > 1)
        reader.fail("parameter", fmt::format("layers {} hold fluorophores", fmt::join(dyed, ", ")),
                    fmt::format("say which, layer = {}, or sweep each by itself", dyed.front()));
    return dyed.empty() ? -1 : dyed.front();
}

void resolve_concentration(const TableReader& reader, const Study& study, Sweep& sweep) {
    sweep.kind = SweepKind::Concentration;
    sweep.index = reader.integer_or("fluorophore", -1, 0, most_index);
    sweep.layer = reader.has("layer") ? reader.integer_or("layer", 0, 0, most_index)
                                      : layer_of_dyes(reader, study, sweep.position);
    TomlPath all{"material", study.material, "substrate", "reradiation", "fluorophores"};
    if (sweep.layer >= 0)
        all = {"material", study.material, "layer", std::to_string(sweep.layer), "fluorophores"};
    sweep.path = settled_path(study.base, all, sweep.position);
    const std::size_t of_all = sweep.path.size();
    sweep.path.insert(sweep.path.end(),
                      {element(sweep.index), sweep.layer < 0 ? "excitation" : "concentration"});
    node_at(study.base, sweep.path, sweep.index < 0 ? of_all : of_all + 1, sweep.position);
}

void resolve_parameter(const TableReader& reader, const Study& study, Sweep& sweep) {
    const std::string& parameter = sweep.label;
    const auto layer_key = layer_keys.find(parameter);
    if (parameter == "angle") {
        resolve_angle(reader, study, sweep);
    } else if (parameter == "illuminant") {
        resolve_illuminant(reader, study, sweep);
    } else if (parameter == "concentration") {
        resolve_concentration(reader, study, sweep);
    } else if (parameter == "matrix") {
        sweep.kind = SweepKind::Matrix;
        sweep.path = settled_path(
            study.base, {"material", study.material, "substrate", "reradiation"}, sweep.position);
    } else {
        const int layer = reader.integer_or("layer", 0, 0, most_index);
        sweep.path = settled_path(
            study.base,
            {"material", study.material, "layer", std::to_string(layer), layer_key->second},
            sweep.position);
    }
}

/// Two words for one thing: they exclude each other in a scene.
std::string spelt_once(const std::string& part) {
    if (part == "alpha")
        return "roughness_deg";
    return part == "intensity" || part == "irradiance" ? "radiance" : part;
}

} // namespace

void resolve_target(const TableReader& reader, const Study& study, Sweep& sweep) {
    const bool has_key = reader.has("key");
    if (has_key == reader.has("parameter"))
        throw_input_error(has_key ? reader.position_of_key("key") : reader.position(),
                          has_key ? "both key and parameter are given"
                                  : "the sweep has neither key nor parameter",
                          "give one of them");
    sweep.position = reader.position_of_key(has_key ? "key" : "parameter");
    sweep.label = has_key ? reader.text("key") : reader.choice("parameter", parameters);
    refuse_choice(reader, has_key ? "" : sweep.label);
    if (has_key)
        sweep.path = settled_path(study.base, toml_path(sweep.label), sweep.position);
    else
        resolve_parameter(reader, study, sweep);
    sweep.label = reader.text_or("label", sweep.label);
    sweep.unit = unit_of(sweep);
}

bool targets_collide(const Sweep& a, const Sweep& b) {
    const std::size_t shorter = std::min(a.path.size(), b.path.size());
    for (std::size_t k = 0; k < shorter; ++k)
        if (spelt_once(a.path[k]) != spelt_once(b.path[k]) && a.path[k] != every_element &&
            b.path[k] != every_element)
            return false;
    return true;
}

} // namespace reradiant
