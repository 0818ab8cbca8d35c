#include "host/scene/material_reader.h"

#include "host/paths.h"
#include "host/scene/spectrum_reader.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t MAX_LAYERS = 256;
constexpr double MAX_IOR = 100.0;

Distribution distribution_from_name(const std::string& name) {
    return name == "blinn"      ? Distribution::Blinn
           : name == "beckmann" ? Distribution::Beckmann
                                : Distribution::Ggx;
}

/// Width of a layer's interface from `roughness_deg` or `alpha`, 0 when neither is given.
double read_alpha(const TableReader& reader, Distribution distribution) {
    if (reader.has("roughness_deg") && reader.has("alpha"))
        reader.fail("alpha", "both roughness_deg and alpha are given", "give one of them");
    if (reader.has("alpha"))
        return reader.number("alpha", NumberRange::within(0.0, 1.0));
    const double degrees = reader.number_or("roughness_deg", 0.0,
                                            {.low = 0.0, .high = 90.0, .high_is_allowed = false});
    const double alpha = alpha_from_roughness_deg(distribution, degrees);
    if (!(alpha <= 1.0))
        reader.fail("roughness_deg",
                    fmt::format("roughness_deg = {} is a width alpha of {}", degrees, alpha),
                    "alpha must be at most 1");
    return alpha;
}

Layer read_layer(const toml::table& table, const std::string& file, std::size_t index,
                 LoadState& state) {
    const TableReader reader(table, file, fmt::format("[[material.layer]] {}", index),
                             {"ior", "roughness_deg", "alpha", "distribution", "scattering",
                              "thickness", "absorption", "scattering_coefficient", "anisotropy"});
    for (const char* key : {"scattering_coefficient", "anisotropy"})
        if (reader.has(key))
            reader.fail(key, fmt::format("{}: slabs do not scatter in this version", key),
                        "leave it out; absorption is available");
    Layer layer;
    layer.ior = read_spectrum_key(reader, "ior", SpectrumLimits::positive(MAX_IOR), state);
    if (reader.has("distribution"))
        layer.distribution =
            distribution_from_name(reader.choice("distribution", {"blinn", "beckmann", "ggx"}));
    layer.alpha = read_alpha(reader, layer.distribution);
    if (reader.has("scattering"))
        layer.scattering = reader.choice("scattering", {"multiple", "single"}) == "single"
                               ? Scattering::Single
                               : Scattering::Multiple;
    layer.thickness = reader.number_or("thickness", 1.0, NumberRange::within(0.0, 1e18));
    if (reader.has("absorption"))
        layer.absorption =
            read_spectrum_key(reader, "absorption", SpectrumLimits::emission(), state);
    return layer;
}

Substrate read_substrate(const TableReader& material, LoadState& state) {
    const std::string type =
        type_of_table(material.plain_table("substrate"), material.file(), "[material.substrate]",
                      {"lambert", "oren-nayar", "conductor"});
    if (type != "lambert")
        throw_input_error(
            position_of(material.file(),
                        material.plain_table("substrate").find("type")->first.source()),
            fmt::format("this version has no substrate of type \"{}\"", type),
            "use type = \"lambert\"");
    const TableReader reader = material.table("substrate", {"type", "reflectance", "reradiation"});
    if (reader.has("reflectance") && reader.has("reradiation"))
        reader.fail("reflectance", "both reflectance and reradiation are given",
                    "a matrix holds its reflectance on the diagonal, fluorophores take it as "
                    "reradiation.reflectance");
    Substrate substrate;
    if (reader.has("reradiation"))
        read_reradiation_key(reader, "reradiation", substrate, state);
    else if (reader.has("reflectance"))
        substrate.reflectance =
            read_spectrum_key(reader, "reflectance", SpectrumLimits::fraction(), state);
    else
        substrate.reflectance = Spectrum::constant(0.5);
    return substrate;
}

Material read_preset(const toml::table& table, const std::string& file, MaterialPlace place,
                     LoadState& state) {
    const TableReader reader(table, file, "a material with a preset", {"name", "preset"});
    if (place == MaterialPlace::PresetFile)
        reader.fail("preset", "a preset refers to another preset", "write the material out");
    const std::string preset = reader.text("preset");
    const auto known = preset_names();
    if (std::find(known.begin(), known.end(), preset) == known.end())
        reader.fail("preset", fmt::format("no preset is called \"{}\"", preset),
                    fmt::format("there are: {}", fmt::join(known, ", ")));
    const fs::path path = spectra_directory() / "materials" / (preset + ".toml");
    const std::string text = read_file(path, reader.position_of_key("preset"));
    state.add_to_digest(text);
    const toml::table root = parse_toml(path.string(), text);
    const TableReader preset_file(root, path.string(), "a material file", {"material"});
    Material material = read_material(preset_file.plain_table("material"), path.string(),
                                      MaterialPlace::PresetFile, state);
    material.name = reader.text_or("name", preset);
    return material;
}

} // namespace

std::vector<std::string> preset_names() {
    std::vector<std::string> names;
    std::error_code ignored;
    for (fs::directory_iterator entry(spectra_directory() / "materials", ignored), end;
         entry != end; entry.increment(ignored))
        if (entry->path().extension() == ".toml")
            names.push_back(entry->path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

Material read_material(const toml::table& table, const std::string& file, MaterialPlace place,
                       LoadState& state) {
    const std::string name = place == MaterialPlace::Scene ? "[[material]]" : "[material]";
    const std::vector<std::string> keys{"name", "model", "layer", "substrate", "preset"};
    const TableReader reader(table, file, name, keys);
    if (place == MaterialPlace::Scene && reader.text("name").empty())
        reader.fail("name", "the name is empty", "give a name for shapes to refer to");
    if (reader.has("preset"))
        return read_preset(table, file, place, state);
    Material material;
    material.name = reader.text_or("name", fs::path(file).stem().string());
    if (reader.has("model"))
        material.model =
            model_from_name(reader.choice("model", {"auto", "adding", "weidlich-wilkie", "walk"}));
    if (material.model == Model::Walk)
        reader.fail("model", "this version has no model \"walk\"",
                    "use auto, adding or weidlich-wilkie");
    const auto layers = reader.tables("layer");
    if (layers.size() > MAX_LAYERS)
        reader.fail("layer", fmt::format("the material has {} layers", layers.size()),
                    fmt::format("give at most {}", MAX_LAYERS));
    for (std::size_t i = 0; i < layers.size(); ++i)
        material.stack.layers.push_back(read_layer(*layers[i], file, i, state));
    material.substrate = read_substrate(reader, state);
    return material;
}

std::array<double, 2> default_range_nm(bool fluorescent) {
    return {fluorescent ? 300.0 : 380.0, 780.0};
}

} // namespace reradiant
