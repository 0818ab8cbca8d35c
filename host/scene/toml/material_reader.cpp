#include "host/scene/toml/material_reader.h"

#include "host/scene/model/model_choice.h"
#include "host/scene/model/textured_value.h"
#include "host/scene/toml/stack_reader.h"
#include "kernels/core/shared.h"
#include "reradiant/paths.h"
#include "reradiant/scene_file.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t MAX_LEVEL_TEXTURES = 3;
constexpr std::size_t MAX_VARIANTS = 512;

/// A material that names a model which cannot do it is refused at that key.
void refuse_model(const TableReader& reader, const Material& material) {
    if (const std::optional<ModelRefusal> refusal = model_refusal(material, material.model))
        reader.fail("model", refusal->reason, refusal->remedy);
}

/// Reads what lies at the bottom: a substrate, or the lower face of a sheet.
void read_bottom(const TableReader& reader, Material& material, LoadState& state) {
    material.substrate = read_substrate(reader, state);
    if (material.substrate.type != SubstrateType::None) {
        if (reader.has("back"))
            reader.fail("back", "only a sheet has a lower face, and this material has a substrate",
                        "leave [material.back] out, or write type = \"none\" in "
                        "[material.substrate]");
        return;
    }
    if (material.stack.layers.empty())
        reader.fail("substrate", "the substrate is \"none\" and there is no layer",
                    "a sheet needs at least one [[material.layer]]");
    material.stack.lower_face = read_lower_face(reader, state);
}

/// The material at the levels that the textures stand at.
Material read_at_levels(const TableReader& reader, LoadState& state) {
    Material material;
    material.name = reader.text_or("name", fs::path(reader.file()).stem().string());
    material.position = reader.position();
    if (reader.has("model"))
        material.model =
            model_from_name(reader.choice("model", {"auto", "adding", "weidlich-wilkie", "walk"}));
    const auto layers = reader.tables("layer");
    if (layers.size() > MAX_LAYERS)
        reader.fail("layer", fmt::format("the material has {} layers", layers.size()),
                    fmt::format("give at most {}", MAX_LAYERS));
    for (std::size_t i = 0; i < layers.size(); ++i)
        material.stack.layers.push_back(read_layer(*layers[i], reader.file(), i, state));
    read_bottom(reader, material, state);
    refuse_model(reader, material);
    return material;
}

std::vector<std::size_t> level_counts(const TableReader& reader, const MaterialReading& reading,
                                      const LoadState& state) {
    if (reading.textures.size() > MAX_LEVEL_TEXTURES)
        throw_input_error(
            reader.position(),
            fmt::format("the material's values follow {} textures", reading.textures.size()),
            fmt::format("at most {}; normal and mix do not count", MAX_LEVEL_TEXTURES));
    std::vector<std::size_t> counts;
    std::size_t variants = 1;
    for (const int texture : reading.textures) {
        const int levels = state.textures[static_cast<std::size_t>(texture)].levels;
        counts.push_back(static_cast<std::size_t>(levels));
        variants *= counts.back();
    }
    if (variants > MAX_VARIANTS)
        throw_input_error(
            reader.position(),
            fmt::format("the levels of the material's textures have {} combinations", variants),
            fmt::format("at most {}: give the textures fewer levels", MAX_VARIANTS));
    return counts;
}

void read_variants(const TableReader& reader, MaterialReading& reading, LoadState& state) {
    TextureScope& scope = *state.texture_scope;
    scope.forget_used();
    scope.set_levels({});
    reading.representative = read_at_levels(reader, state);
    reading.textures = scope.used();
    if (reading.textures.empty())
        return;
    const std::vector<std::size_t> counts = level_counts(reader, reading, state);
    std::vector<std::size_t> digits(counts.size(), 0);
    for (bool more = true; more;) {
        std::vector<double> levels;
        for (std::size_t k = 0; k < digits.size(); ++k)
            levels.push_back(static_cast<double>(digits[k]) / static_cast<double>(counts[k] - 1));
        scope.set_levels(std::move(levels));
        reading.variants.push_back(read_at_levels(reader, state));
        more = false;
        for (std::size_t k = digits.size(); k-- > 0 && !more;) {
            digits[k] = (digits[k] + 1) % counts[k];
            more = digits[k] != 0;
        }
    }
}

void read_normal(const TableReader& reader, MaterialReading& reading, LoadState& state) {
    reading.normal_texture = read_texture_index(reader, "normal", state);
    const Texture& texture = state.textures[static_cast<std::size_t>(reading.normal_texture)];
    const bool tilts =
        (texture.type == TextureType::Noise || texture.type == TextureType::Voronoi) &&
        texture.tilt_deg > 0.0;
    if (!tilts && !texture.is_normal_map)
        reader.fail("normal", fmt::format("the texture \"{}\" has no normals", texture.name),
                    "use noise or voronoi with tilt_deg above 0, or an image with normal_map = "
                    "true");
}

void read_mix(const TableReader& reader, MaterialReading& reading, LoadState& state) {
    const TableReader mix = reader.table("mix", {"with", "weight"});
    reading.mixed_with = mix.text("with");
    reading.mixed_with_position = mix.position_of_key("with");
    if (!is_texture_reference(mix.required("weight"))) {
        reading.mix_weight = mix.number("weight", NumberRange::within(0.0, 1.0));
        return;
    }
    reading.mix_texture = read_texture_index(mix, "weight", state);
    const Texture& texture = state.textures[static_cast<std::size_t>(reading.mix_texture)];
    if (texture.is_normal_map)
        mix.fail("weight", fmt::format("the texture \"{}\" is a normal map", texture.name),
                 "use it as normal = { texture = ... }");
}

/// A number, or a texture with what its ends stand for.
void read_opacity(const TableReader& reader, MaterialReading& reading, LoadState& state) {
    const NumberRange share = NumberRange::within(0.0, 1.0);
    const toml::node& node = reader.required("opacity");
    if (!is_texture_reference(node)) {
        reading.opacity.fill(number_at(node, reader.position_of_key("opacity"), "opacity", share));
        return;
    }
    const TextureReference reference =
        read_texture_reference(node, reader.file(), "opacity", state);
    reading.opacity_texture = reference.texture;
    reading.opacity = {0.0, 1.0};
    for (const auto& [end, value] : {std::pair{&reference.low, &reading.opacity[0]},
                                     std::pair{&reference.high, &reading.opacity[1]}})
        if (end->node != nullptr)
            *value = number_at(*end->node, position_of(end->file, *end->node), "opacity", share);
}

/// What a surface has besides its material.
void read_surface_keys(const TableReader& reader, MaterialReading& reading, LoadState& state) {
    reader.describe("normal", "texture");
    if (reader.has("normal"))
        read_normal(reader, reading, state);
    if (reader.has("mix"))
        read_mix(reader, reading, state);
    reader.describe("opacity", "number or texture, at least 0 and at most 1", "1");
    if (reader.has("opacity"))
        read_opacity(reader, reading, state);
}

const std::vector<std::string> MATERIAL_KEYS{"name",   "model",  "layer", "substrate", "back",
                                             "preset", "normal", "mix",   "opacity"};

/// The file of a preset: one of spectra/materials, or any material file by a name that ends so.
fs::path preset_file(const std::string& preset, const SourcePosition& at, LoadState& state) {
    if (preset.ends_with(".toml"))
        return state.resolve_and_digest(preset, at);
    const auto known = preset_names();
    if (std::find(known.begin(), known.end(), preset) == known.end())
        throw_input_error(at, fmt::format("no preset is called \"{}\"", preset),
                          fmt::format("there are: {}; a material file's name ends with .toml",
                                      fmt::join(known, ", ")));
    return state.resolve_and_digest(
        (spectra_directory() / "materials" / (preset + ".toml")).string(), at);
}

/// A preset with the keys of `own` laid over it: all but its name and the preset's.
MaterialReading read_preset_under(const toml::table& own, const std::string& preset,
                                  const SourcePosition& at, LoadState& state) {
    const fs::path path = preset_file(preset, at, state);
    toml::table root = parse_toml(path.string(), read_file(path, at));
    const TableReader preset_file(root, path.string(), "a material file", {"material", "texture"});
    preset_file.plain_table("material");
    toml::table& material = *root["material"].as_table();
    if (const auto nested = material.find("preset"); nested != material.end())
        throw_input_error(position_of(path.string(), nested->first.source()),
                          "a preset refers to another preset", "write the material out");
    toml::table above = own;
    above.erase("name");
    above.erase("preset");
    lay_over(above, material);
    TextureScope textures(preset_file, state);
    TextureScope* const outer = state.texture_scope;
    if (outer != nullptr && !above.empty())
        textures.add_from(*outer);
    state.texture_scope = &textures;
    MaterialReading reading =
        read_material(material, path.string(), MaterialPlace::PresetFile, state);
    state.texture_scope = outer;
    return reading;
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

MaterialReading read_preset(const std::string& preset, const SourcePosition& at, LoadState& state) {
    return read_preset_under({}, preset, at, state);
}

MaterialReading read_material(const toml::table& table, const std::string& file,
                              MaterialPlace place, LoadState& state) {
    const std::string name = place == MaterialPlace::Scene ? "[[material]]" : "[material]";
    const TableReader reader(table, file, name, MATERIAL_KEYS);
    if (place == MaterialPlace::Scene && reader.text("name").empty())
        reader.fail("name", "the name is empty", "give a name for shapes to refer to");
    reader.describe("preset", "string");
    MaterialReading reading;
    if (reader.has("preset")) {
        const std::string preset = reader.text("preset");
        reading = read_preset_under(table, preset, reader.position_of_key("preset"), state);
        const std::string own_name = reader.text_or("name", fs::path(preset).stem().string());
        reading.representative.name = own_name;
        for (Material& variant : reading.variants)
            variant.name = own_name;
        return reading;
    }
    read_variants(reader, reading, state);
    read_surface_keys(reader, reading, state);
    return reading;
}

std::array<double, 2> default_range_nm(bool fluorescent) {
    return {fluorescent ? 300.0 : 380.0, 780.0};
}

} // namespace reradiant
