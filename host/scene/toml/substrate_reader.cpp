#include "host/scene/toml/material_reader.h"

#include "host/scene/model/textured_value.h"
#include "host/scene/toml/pigment_reader.h"
#include "host/scene/toml/spectrum_reader.h"
#include "host/scene/toml/stack_reader.h"

#include <algorithm>
#include <numbers>

#include <fmt/core.h>

namespace reradiant {

namespace {

/// An EXR image may hold any number; as a reflectance, times its factor, it lies within 0 and 1.
void refuse_beyond_reflectance(const Image& image, const Spectrum& factor,
                               const SourcePosition& at) {
    constexpr float rounding = 1e-3f; // of half floats
    const auto most = static_cast<float>(factor.maximum(380.0, 780.0));
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        if (const float value = image.rgb[i] * most;
            !(value >= -rounding && value <= 1 + rounding)) {
            const std::size_t pixel = i / 3, width = static_cast<std::size_t>(image.width);
            throw_input_error(at,
                              fmt::format("pixel ({}, {}) of {} makes a reflectance of {:.4g}",
                                          pixel % width, pixel / width, image.file.string(), value),
                              "give an image with numbers from 0 to 1, or a smaller high");
        }
}

/// An image as a reflectance keeps its colours: `high` of the reference, 1 by default, times its
/// rgb. With a `low` it is a texture like any other, by its grey value.
bool read_reflectance_image(const TableReader& reader, Substrate& substrate, LoadState& state) {
    const toml::node& node = reader.required("reflectance");
    if (!is_texture_reference(node) || state.texture_scope == nullptr)
        return false;
    const TableReader reference(*node.as_table(), reader.file(),
                                "the texture reference reflectance", {"texture", "low", "high"});
    const TextureScope::Entry& entry = state.texture_scope->entry(reference);
    const Texture& texture = state.textures[static_cast<std::size_t>(entry.texture)];
    if (texture.type != TextureType::Image || texture.is_normal_map || reference.has("low") ||
        entry.table->contains("low"))
        return false;
    substrate.reflectance_image = entry.texture;
    substrate.reflectance = Spectrum::constant(1.0);
    const SpectrumLimits limits = SpectrumLimits::fraction();
    if (reference.has("high"))
        substrate.reflectance = read_spectrum_key(reference, "high", limits, state);
    else if (const toml::node* high = entry.table->get("high"))
        substrate.reflectance = read_spectrum_node(
            *high, entry.file, position_of(entry.file, *high), "high", limits, state);
    refuse_beyond_reflectance(state.images[static_cast<std::size_t>(texture.image)],
                              substrate.reflectance, reader.position_of_key("reflectance"));
    return true;
}

/// `reflectance`, `reradiation` or pigments of a diffuse substrate.
void read_diffuse_colour(const TableReader& reader, Substrate& substrate, LoadState& state) {
    if (has_pigments(reader)) {
        read_pigments(reader, substrate, state);
        return;
    }
    if (reader.has("reflectance") && reader.has("reradiation"))
        reader.fail("reflectance", "both reflectance and reradiation are given",
                    "a matrix holds its reflectance on the diagonal, fluorophores take it as "
                    "reradiation.reflectance");
    if (reader.has("reradiation"))
        read_reradiation_key(reader, "reradiation", substrate, state);
    else if (!reader.has("reflectance"))
        substrate.reflectance = Spectrum::constant(0.5);
    else if (!read_reflectance_image(reader, substrate, state))
        substrate.reflectance =
            read_spectrum_key(reader, "reflectance", SpectrumLimits::fraction(), state);
}

/// Keys of the substrates that there are.
std::vector<std::string> keys_of_substrates() {
    std::vector<std::string> keys{"sigma", "reflectance", "reradiation"};
    keys.insert(keys.end(), pigment_keys().begin(), pigment_keys().end());
    keys.insert(keys.end(), conductor_keys().begin(), conductor_keys().end());
    return keys;
}

/// A sheet has no substrate, and thus no key of one.
void refuse_keys_of_substrates(const TableReader& material) {
    const std::vector<std::string> keys = keys_of_substrates();
    for (const auto& [key, node] : material.plain_table("substrate"))
        if (std::find(keys.begin(), keys.end(), key.str()) != keys.end())
            throw_input_error(
                position_of(material.file(), key.source()),
                fmt::format("the substrate is \"none\", and nothing has no {}", key.str()),
                "leave it out; [material.back] says how rough a sheet's lower face is");
}

} // namespace

Substrate read_substrate(const TableReader& material, LoadState& state) {
    const std::string type =
        type_of_table(material.plain_table("substrate"), material.file(), "[material.substrate]",
                      {"lambert", "oren-nayar", "conductor", "none"});
    const auto keys = [&](std::vector<std::string> own) {
        own.push_back("type");
        return material.table("substrate", own);
    };
    const auto diffuse_keys = [&](std::vector<std::string> own) {
        own.insert(own.end(), pigment_keys().begin(), pigment_keys().end());
        own.insert(own.end(), {"reflectance", "reradiation"});
        return keys(own);
    };
    Substrate substrate;
    if (type == "conductor") {
        substrate.type = SubstrateType::Conductor;
        substrate.conductor = read_conductor(keys(conductor_keys()), state);
    } else if (type == "oren-nayar") {
        const TableReader reader = diffuse_keys({"sigma"});
        substrate.type = SubstrateType::OrenNayar;
        substrate.sigma = read_number_key(reader, "sigma",
                                          NumberRange::within(0.0, 0.5 * std::numbers::pi), state);
        read_diffuse_colour(reader, substrate, state);
    } else if (type == "none") {
        refuse_keys_of_substrates(material);
        keys({});
        substrate.type = SubstrateType::None;
    } else {
        read_diffuse_colour(diffuse_keys({}), substrate, state);
    }
    return substrate;
}

} // namespace reradiant
