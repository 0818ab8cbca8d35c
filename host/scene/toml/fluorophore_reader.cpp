#include "host/scene/toml/fluorophore_reader.h"

#include "host/scene/model/fluorescence_ranges.h"
#include "host/scene/model/textured_value.h"
#include "host/scene/toml/material_reader.h"
#include "host/scene/toml/spectrum_reader.h"
#include "reradiant/reradiation.h"

#include <memory>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr double MAX_CONCENTRATION = 1e9; ///< optical depths stay far within double precision

/// Reads how much of what the dye absorbs is sent out: by shares or by a band.
void read_what_is_sent_out(const TableReader& reader, SlabDye& dye, LoadState& state) {
    if (!reader.has("shares")) {
        if (!reader.has("emission"))
            reader.fail("emission", fmt::format("{} has no \"emission\"", reader.name()),
                        "add emission = ... or shares = { file = ... }");
        FluorescentBand band = read_fluorescent_band(reader, "fluorophore", state);
        dye.emission = std::move(band.emission);
        dye.quantum_yield = band.quantum_yield;
        return;
    }
    for (const char* key : {"emission", "quantum_yield"})
        if (reader.has(key))
            reader.fail(key, fmt::format("both shares and {} are given", key),
                        "shares say already what is sent out of every band");
    dye.shares = std::make_shared<const ReradiationMatrix>(
        read_matrix_file(reader.table("shares", {"file"}), state));
}

void warn_of_darkness(const TableReader& reader, const SlabDye& dye, LoadState& state) {
    if (!dye.absorbs() || dye.quantum_yield == 0.0 || !fluorescence_ranges(dye).is_empty())
        return;
    state.warn(reader.position_of_key(dye.shares ? "shares" : "emission"),
               dye.shares
                   ? "the shares are zero wherever the fluorophore absorbs: it sends out "
                     "nothing"
                   : fmt::format("the fluorophore emits up to {} nm and absorbs from {} nm "
                                 "on: it sends out nothing, since light is emitted above "
                                 "the wavelength that was absorbed",
                                 support_nm(dye.emission)[1], support_nm(dye.absorption)[0]));
}

SlabDye read_slab_dye(const toml::table& table, const std::string& file, std::size_t index,
                      LoadState& state) {
    const TableReader reader(
        table, file, fmt::format("[[material.layer.fluorophores]] {}", index),
        {"absorption", "concentration", "emission", "quantum_yield", "shares"});
    SlabDye dye;
    dye.absorption = read_spectrum_key(reader, "absorption", SpectrumLimits::emission(), state);
    dye.concentration = read_number_key_or(reader, "concentration", 1.0,
                                           NumberRange::within(0.0, MAX_CONCENTRATION), state);
    read_what_is_sent_out(reader, dye, state);
    warn_of_darkness(reader, dye, state);
    return dye;
}

} // namespace

FluorescentBand read_fluorescent_band(const TableReader& reader, const std::string& what,
                                      LoadState& state) {
    FluorescentBand band;
    band.emission = read_spectrum_key(reader, "emission", SpectrumLimits::emission(), state);
    band.quantum_yield =
        read_number_key_or(reader, "quantum_yield", 1.0, NumberRange::within(0.0, 1.0), state);
    if (band.emission.is_zero_within(200.0, 1000.0))
        reader.fail("emission", "emission is zero from 200 to 1000 nm",
                    fmt::format("give the band that the {} emits", what));
    return band;
}

std::vector<SlabDye> read_slab_dyes(const TableReader& layer, LoadState& state) {
    const auto tables = layer.tables("fluorophores");
    if (tables.size() > MAX_FLUOROPHORES)
        layer.fail("fluorophores", fmt::format("the layer has {} fluorophores", tables.size()),
                   fmt::format("give at most {}", MAX_FLUOROPHORES));
    std::vector<SlabDye> dyes;
    for (std::size_t i = 0; i < tables.size(); ++i)
        dyes.push_back(read_slab_dye(*tables[i], layer.file(), i, state));
    return dyes;
}

} // namespace reradiant
