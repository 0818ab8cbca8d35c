#include "host/scene/toml/pigment_reader.h"

#include "host/scene/model/textured_value.h"
#include "host/scene/toml/fluorophore_reader.h"
#include "host/scene/toml/spectrum_reader.h"
#include "host/spectral/matrix/kubelka_munk.h"
#include "reradiant/reradiation.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr std::size_t MAX_PIGMENTS = 64;
constexpr double MAX_AMOUNT = 1e9; ///< products of three stay far within double precision

const SpectrumLimits COEFFICIENT{.high = MAX_AMOUNT};

Pigment read_pigment(const toml::table& table, const std::string& file, std::size_t index,
                     LoadState& state) {
    const TableReader reader(table, file, fmt::format("pigment {}", index),
                             {"absorption", "scattering", "concentration"});
    Pigment pigment;
    pigment.absorption = read_spectrum_key(reader, "absorption", COEFFICIENT, state);
    pigment.scattering = read_spectrum_key(reader, "scattering", COEFFICIENT, state);
    pigment.concentration = read_number_key_or(reader, "concentration", 1.0,
                                               NumberRange::within(0.0, MAX_AMOUNT), state);
    return pigment;
}

Dye read_dye(const toml::table& table, const std::string& file, std::size_t index,
             LoadState& state) {
    const TableReader reader(table, file, fmt::format("dye {}", index),
                             {"absorption", "emission", "quantum_yield", "concentration"});
    Dye dye;
    dye.absorption = read_spectrum_key(reader, "absorption", COEFFICIENT, state);
    FluorescentBand band = read_fluorescent_band(reader, "dye", state);
    dye.emission = std::move(band.emission);
    dye.quantum_yield = band.quantum_yield;
    dye.concentration = read_number_key_or(reader, "concentration", 1.0,
                                           NumberRange::within(0.0, MAX_AMOUNT), state);
    return dye;
}

PigmentLayer read_layer_of_pigments(const TableReader& reader, LoadState& state) {
    PigmentLayer layer;
    for (const char* key : {"pigments", "dyes"})
        if (reader.tables(key).size() > MAX_PIGMENTS)
            reader.fail(key, fmt::format("there are {} {}", reader.tables(key).size(), key),
                        fmt::format("give at most {}", MAX_PIGMENTS));
    const auto pigments = reader.tables("pigments"), dyes = reader.tables("dyes");
    if (pigments.empty() && dyes.empty())
        reader.fail(reader.has("backing") ? "backing" : "thickness",
                    "only a substrate of pigments has a thickness and a backing",
                    "add [[material.substrate.pigments]]");
    for (std::size_t i = 0; i < pigments.size(); ++i)
        layer.pigments.push_back(read_pigment(*pigments[i], reader.file(), i, state));
    for (std::size_t i = 0; i < dyes.size(); ++i)
        layer.dyes.push_back(read_dye(*dyes[i], reader.file(), i, state));
    layer.thickness = read_number_key_or(reader, "thickness", PigmentLayer::OPAQUE,
                                         NumberRange::within(0.0, MAX_AMOUNT), state);
    if (reader.has("backing") && !reader.has("thickness"))
        reader.fail("backing", "an opaque layer hides its backing", "give it a thickness");
    if (reader.has("backing"))
        layer.backing = read_spectrum_key(reader, "backing", SpectrumLimits::fraction(), state);
    return layer;
}

} // namespace

const std::vector<std::string>& pigment_keys() {
    static const std::vector<std::string> keys{"pigments", "dyes", "thickness", "backing"};
    return keys;
}

bool has_pigments(const TableReader& substrate) {
    return std::any_of(pigment_keys().begin(), pigment_keys().end(),
                       [&](const std::string& key) { return substrate.has(key); });
}

void read_pigments(const TableReader& reader, Substrate& substrate, LoadState& state) {
    for (const char* key : {"reflectance", "reradiation"})
        if (reader.has(key))
            reader.fail(key, fmt::format("both {} and pigments are given", key),
                        "pigments and dyes make the reflectance and the matrix themselves");
    const PigmentLayer layer = read_layer_of_pigments(reader, state);
    const std::string place = reader.has("pigments") ? "pigments" : "dyes";
    try {
        if (layer.is_fluorescent()) {
            substrate.matrix = std::make_shared<const ReradiationMatrix>(
                kubelka_munk_matrix(layer, grid_from_range(300.0, 780.0, 5.0)));
            substrate.reflectance = substrate.matrix->reflectance();
        } else {
            substrate.reflectance = kubelka_munk_spectrum(layer);
        }
    } catch (const std::invalid_argument& error) {
        reader.fail(place, error.what(), "give it a thickness, or something that scatters");
    }
    state.track(substrate.reflectance, reader.position_of_key(place), "the layer of pigments");
}

} // namespace reradiant
