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
    const auto known = preset_names();
    if (std::find(known.begin(), known.end(), preset) == known.end())
        throw_input_error(at, fmt::format("no preset is called \"{}\"", preset),
                          fmt::format("there are: {}", fmt::join(known, ", ")));
    const fs::path path = spectra_directory() / "materials" / (preset + ".toml");
    state.resolve_and_digest(path.string(), at);
    const toml::table root = parse_toml(path.string(), read_file(path, at));
    const TableReader preset_file(root, path.string(), "a material file", {"material", "texture"});
    TextureScope own_textures(preset_file, state);
    TextureScope* const outer = std::exchange(state.texture_scope, &own_textures);
    MaterialReading reading = read_material(preset_file.plain_table("material"), path.string(),
                                            MaterialPlace::PresetFile, state);
    state.texture_scope = outer;
    return reading;
}

MaterialReading read_material(const toml::table& table, const std::string& file,
                              MaterialPlace place, LoadState& state) {
    const std::string name = place == MaterialPlace::Scene ? "[[material]]" : "[material]";
    const TableReader reader(
        table, file, name,
        {"name", "model", "layer", "substrate", "back", "preset", "normal", "mix"});
    if (place == MaterialPlace::Scene && reader.text("name").empty())
        reader.fail("name", "the name is empty", "give a name for shapes to refer to");
    MaterialReading reading;
    reader.describe("preset", "string"); // read below by a reader of its own
    if (reader.has("preset")) {
        const TableReader named(table, file, "a material with a preset", {"name", "preset"});
        if (place == MaterialPlace::PresetFile)
            named.fail("preset", "a preset refers to another preset", "write the material out");
        const std::string preset = named.text("preset");
        reading = read_preset(preset, named.position_of_key("preset"), state);
        const std::string own_name = named.text_or("name", preset);
        reading.representative.name = own_name;
        for (Material& variant : reading.variants)
            variant.name = own_name;
        return reading;
    }
    read_variants(reader, reading, state);
    reader.describe("normal", "texture");
    if (reader.has("normal"))
        read_normal(reader, reading, state);
    if (reader.has("mix"))
        read_mix(reader, reading, state);
    return reading;
}

std::array<double, 2> default_range_nm(bool fluorescent) {
    return {fluorescent ? 300.0 : 380.0, 780.0};
}

} // namespace reradiant
