#include "host/scene/toml/material_reader.h"

#include "host/scene/model/dye_concentration.h"
#include "host/scene/model/textured_value.h"
#include "host/scene/toml/fluorophore_reader.h"
#include "host/scene/toml/spectrum_reader.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "reradiant/reradiation.h"
#include "reradiant/spectral_files.h"

#include <stdexcept>

#include <fmt/core.h>

namespace reradiant {

namespace {

const std::vector<std::string> FLUOROPHORE_KEYS{"excitation", "concentration", "emission",
                                                "quantum_yield"};

/// Refuses what breaks energy and logs what was repaired. Returns what else there is to warn of.
std::vector<std::string> check_and_repair(ReradiationMatrix& matrix, const SourcePosition& at,
                                          LoadState& state) {
    std::vector<std::string> warnings;
    try {
        const MatrixRepair repair = repair_for_rendering(matrix, warnings);
        if (const std::string text = repair.text(); !text.empty())
            state.warn(at, text);
    } catch (const std::invalid_argument& error) {
        throw_input_error(at, error.what());
    }
    return warnings;
}

/// `strength` is the share of the fluorescence that is left; the matrix keeps its diagonal.
void read_matrix(const TableReader& reader, Substrate& substrate, LoadState& state) {
    ReradiationMatrix matrix = read_matrix_file(reader, state);
    const double strength =
        read_number_key_or(reader, "strength", 1.0, NumberRange::within(0.0, 1.0), state);
    if (strength != 1.0)
        matrix.values -= (1.0 - strength) * matrix.fluorescent_part();
    substrate.reflectance = matrix.reflectance();
    substrate.matrix = std::make_shared<const ReradiationMatrix>(std::move(matrix));
}

Fluorophore read_fluorophore(const toml::table& table, const std::string& file, std::size_t index,
                             LoadState& state) {
    const TableReader reader(table, file, fmt::format("fluorophore {}", index), FLUOROPHORE_KEYS);
    Fluorophore fluorophore;
    fluorophore.excitation =
        read_spectrum_key(reader, "excitation", SpectrumLimits::fraction(), state);
    FluorescentBand band = read_fluorescent_band(reader, "fluorophore", state);
    fluorophore.emission = std::move(band.emission);
    fluorophore.quantum_yield = band.quantum_yield;
    return fluorophore;
}

/// Applies the keys `concentration` of fluorophores that were read, and the reflectance with them.
void apply_concentrations(const TableReader& reader, const std::vector<const toml::table*>& tables,
                          Substrate& substrate, LoadState& state) {
    constexpr double most = 1e6;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const TableReader fluorophore(*tables[i], reader.file(), fmt::format("fluorophore {}", i),
                                      FLUOROPHORE_KEYS);
        const double concentration = read_number_key_or(fluorophore, "concentration", 1.0,
                                                        NumberRange::within(0.0, most), state);
        if (concentration != 1.0)
            set_dye_concentration(substrate, static_cast<int>(i), concentration);
    }
}

} // namespace

ReradiationMatrix read_matrix_file(const TableReader& reader, LoadState& state) {
    const SourcePosition at = reader.position_of_key("file");
    ReradiationMatrix matrix = read_reradiation(state.resolve_and_digest(reader.text("file"), at));
    for (const std::string& warning : check_and_repair(matrix, at, state))
        state.warn(at, warning);
    return matrix;
}

void read_reradiation_key(const TableReader& table, const std::string& key, Substrate& substrate,
                          LoadState& state) {
    if (table.plain_table(key).contains("file")) {
        read_matrix(table.table(key, {"file", "strength"}), substrate, state);
        return;
    }
    const TableReader reader = table.table(key, {"file", "fluorophores", "reflectance"});
    const auto fluorophores = reader.tables("fluorophores");
    if (fluorophores.empty() || fluorophores.size() > MAX_FLUOROPHORES)
        reader.fail("fluorophores", fmt::format("{} has {} fluorophores", key, fluorophores.size()),
                    fmt::format("give file = ... or 1 to {} fluorophores", MAX_FLUOROPHORES));
    for (std::size_t i = 0; i < fluorophores.size(); ++i)
        substrate.fluorophores.push_back(
            read_fluorophore(*fluorophores[i], reader.file(), i, state));
    if (reader.has("reflectance"))
        substrate.reflectance =
            read_spectrum_key(reader, "reflectance", SpectrumLimits::fraction(), state);
    apply_concentrations(reader, fluorophores, substrate, state);
    const WavelengthGrid grid = grid_from_range(300.0, 780.0, 10.0);
    ReradiationMatrix matrix =
        matrix_from_fluorophores(substrate.fluorophores, substrate.reflectance, grid, grid);
    // This matrix was computed and cannot have been misread, so only the warning about photons
    // matters.
    const SourcePosition at = table.position_of_key(key);
    check_and_repair(matrix, at, state);
    if (const std::string warning = photon_warning(column_balance(matrix).photons, grid);
        !warning.empty())
        state.warn(at, warning);
}

} // namespace reradiant
