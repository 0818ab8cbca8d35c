#include "host/fit/synth/synth_recipe.h"

#include "host/fit/synth/synth_band.h"
#include "host/scene/toml/scene_table.h"
#include "host/scene/toml/spectrum_reader.h"
#include "host/scene/toml/stack_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr std::size_t most_fluorophores = 4;
constexpr std::size_t most_directions = 64; // values that a recipe gives of one angle
/// Ranges that bands of dyes lie in; widths begin with the narrowest that the tables of
/// spectrum_of_bands resolve.
const NumberRange peak_range = NumberRange::within(200.0, 1200.0);
const NumberRange width_nm_range = NumberRange::within(2.0, 500.0);
const NumberRange width_per_cm_range = NumberRange::within(50.0, 20000.0);

WavelengthGrid read_grid(const TableReader& root, const std::string& key) {
    const TableReader reader = root.table(key, {"from", "to", "step"});
    const NumberRange wavelength = NumberRange::within(100.0, 3000.0);
    const double from = reader.number("from", wavelength), to = reader.number("to", wavelength);
    const double step = reader.number("step", NumberRange::within(0.5, 100.0));
    try {
        return grid_from_range(from, to, step);
    } catch (const std::invalid_argument& error) {
        root.fail(key, error.what(), "from and to are centres, a whole number of steps apart");
    }
}

/// A width in one of its two units.
double read_width(const TableReader& reader, double peak_nm) {
    if (reader.has("width_nm") && reader.has("width_per_cm"))
        reader.fail("width_per_cm", "both width_nm and width_per_cm are given", "give one of them");
    if (reader.has("width_per_cm"))
        return reader.number("width_per_cm", width_per_cm_range);
    return width_per_cm(reader.number("width_nm", width_nm_range), peak_nm);
}

WavenumberBand read_band(const TableReader& reader, double peak_nm) {
    WavenumberBand band;
    band.peak_nm = peak_nm;
    band.width_per_cm = read_width(reader, peak_nm);
    band.skew = reader.number_or("skew", 1.0, NumberRange::within(0.1, 10.0));
    return band;
}

/// One band, or a list of them with heights.
std::vector<WavenumberBand> read_excitation(const TableReader& fluorophore) {
    const auto read = [&](const toml::table& table) {
        const TableReader reader(table, fluorophore.file(), "excitation",
                                 {"peak_nm", "width_nm", "width_per_cm", "skew", "height"});
        WavenumberBand band = read_band(reader, reader.number("peak_nm", peak_range));
        band.height =
            reader.number_or("height", 1.0, {.low = 0.0, .high = 1e6, .low_is_allowed = false});
        return band;
    };
    if (fluorophore.required("excitation").is_table())
        return {read(fluorophore.plain_table("excitation"))};
    std::vector<WavenumberBand> bands;
    for (const toml::table* table : fluorophore.tables("excitation"))
        bands.push_back(read(*table));
    if (bands.empty())
        fluorophore.fail("excitation", "excitation holds no band",
                         "give { peak_nm, width_nm, skew } or a list of such bands");
    return bands;
}

const std::vector<std::string> shift_keys{"stokes_shift_nm", "stokes_shift_per_cm"};

/// The one of the keys that is given; none when `optional`.
std::string one_key_of(const TableReader& reader, const std::vector<std::string>& keys,
                       const std::string& purpose) {
    std::string found;
    for (const std::string& key : keys) {
        if (!reader.has(key))
            continue;
        if (!found.empty())
            reader.fail(key, fmt::format("both {} and {} are given", found, key),
                        fmt::format("give one of them {}", purpose));
        found = key;
    }
    return found;
}

/// Peak of the emission that a Stokes shift leads to from the excitation of lowest energy.
double shifted_peak_nm(const TableReader& reader, const std::string& key, double excitation_nm) {
    const double peak_nm =
        key == "stokes_shift_nm"
            ? excitation_nm + reader.number(key, NumberRange::within(0.0, 1000.0))
            : 1e7 / (wavenumber_per_cm(excitation_nm) -
                     reader.number(key, {.low = 0.0,
                                         .high = wavenumber_per_cm(excitation_nm),
                                         .high_is_allowed = false}));
    if (!peak_range.holds(peak_nm))
        reader.fail(key, fmt::format("the emission's peak would lie at {:.6g} nm", peak_nm),
                    "give a smaller shift");
    return peak_nm;
}

/// The mirror image of the excitation band of lowest energy.
WavenumberBand read_mirror(const TableReader& reader, const WavenumberBand& excitation) {
    if (reader.has("emission"))
        reader.fail("emission", "both mirror and emission are given",
                    "the mirror-image rule makes the emission from the excitation");
    const std::string key =
        one_key_of(reader, {"zero_zero_nm", shift_keys[0], shift_keys[1]}, "beside mirror");
    if (key.empty())
        reader.fail("mirror", "mirror does not say where the 0-0 line is",
                    "give zero_zero_nm, stokes_shift_nm or stokes_shift_per_cm");
    if (key == "zero_zero_nm") {
        const double line_nm = reader.number(key, peak_range);
        const double peak =
            2.0 * wavenumber_per_cm(line_nm) - wavenumber_per_cm(excitation.peak_nm);
        if (!(line_nm >= excitation.peak_nm) || !(peak > 0.0) || !peak_range.holds(1e7 / peak))
            reader.fail(key,
                        fmt::format("a 0-0 line at {} nm does not mirror a band at {} nm", line_nm,
                                    excitation.peak_nm),
                        "it lies between the peaks of excitation and emission");
        return mirrored(excitation, wavenumber_per_cm(line_nm));
    }
    const double peak_nm = shifted_peak_nm(reader, key, excitation.peak_nm);
    return mirrored(excitation,
                    0.5 * (wavenumber_per_cm(excitation.peak_nm) + wavenumber_per_cm(peak_nm)));
}

WavenumberBand read_emission(const TableReader& reader, const WavenumberBand& excitation) {
    if (reader.find("mirror") != nullptr && reader.find("mirror")->value_or(false))
        return read_mirror(reader, excitation);
    if (reader.has("zero_zero_nm"))
        reader.fail("zero_zero_nm", "zero_zero_nm is for mirror = true only", "leave it out");
    const TableReader emission =
        reader.table("emission", {"peak_nm", "width_nm", "width_per_cm", "skew"});
    const std::string key = one_key_of(reader, shift_keys, "");
    if (!key.empty() && emission.has("peak_nm"))
        emission.fail("peak_nm", fmt::format("both {} and emission.peak_nm are given", key),
                      "give one of them");
    return read_band(emission, key.empty() ? emission.number("peak_nm", peak_range)
                                           : shifted_peak_nm(reader, key, excitation.peak_nm));
}

Fluorophore read_fluorophore(const toml::table& table, const std::string& file, std::size_t index) {
    const TableReader reader(table, file, fmt::format("[[fluorophore]] {}", index),
                             {"absorptance", "quantum_yield", "excitation", "emission", "mirror",
                              "zero_zero_nm", "stokes_shift_nm", "stokes_shift_per_cm"});
    if (const toml::node* mirror = reader.find("mirror"); mirror && !mirror->is_boolean())
        reader.fail("mirror", fmt::format("mirror is {}", toml_type_name(*mirror)),
                    "write true or false");
    const std::vector<WavenumberBand> excitation = read_excitation(reader);
    const WavenumberBand& lowest =
        *std::max_element(excitation.begin(), excitation.end(),
                          [](const auto& a, const auto& b) { return a.peak_nm < b.peak_nm; });
    Fluorophore fluorophore;
    fluorophore.excitation = spectrum_of_bands(
        excitation,
        reader.number("absorptance", {.low = 0.0, .high = 1.0, .low_is_allowed = false}));
    fluorophore.emission = spectrum_of_bands({read_emission(reader, lowest)}, 1.0);
    fluorophore.quantum_yield = reader.number("quantum_yield", NumberRange::within(0.0, 1.0));
    return fluorophore;
}

void read_fluorophores(const TableReader& root, SynthRecipe& recipe) {
    const auto tables = root.tables("fluorophore");
    if (tables.size() > most_fluorophores)
        root.fail("fluorophore", fmt::format("the recipe has {} fluorophores", tables.size()),
                  fmt::format("give at most {} [[fluorophore]]", most_fluorophores));
    for (std::size_t k = 0; k < tables.size(); ++k)
        recipe.fluorophores.push_back(read_fluorophore(*tables[k], root.file(), k));
}

/// Light is reflected or absorbed, not both: then the photon balance holds whatever the yields.
void refuse_too_much_light(const TableReader& root, const SynthRecipe& recipe) {
    constexpr double rounding = 1e-9;
    const double from = recipe.excitation.lower_edge_nm(0);
    const double to = recipe.excitation.upper_edge_nm(recipe.excitation.count - 1);
    double largest = 0.0, largest_at = from;
    for (double nm = from; nm <= to; nm += 1.0) {
        double sum = recipe.reflectance(nm);
        for (const Fluorophore& fluorophore : recipe.fluorophores)
            sum += fluorophore.excitation(nm);
        if (sum > largest) {
            largest = sum;
            largest_at = nm;
        }
    }
    if (largest > 1.0 + rounding)
        root.fail(root.has("reflectance") ? "reflectance" : "fluorophore",
                  fmt::format("reflectance and absorptances are together {:.4g} at {:.6g} nm",
                              largest, largest_at),
                  "light is either reflected or absorbed: at most 1");
}

/// The recipe's own keys are the substrate, which a sheet has not.
void refuse_bottoms(const TableReader& material) {
    if (material.has("back"))
        material.fail("back", "synth measures a substrate through layers, and a sheet has none",
                      "leave [material.back] out");
    if (material.has("substrate"))
        material.fail("substrate", "a recipe's fluorophores and reflectance are the substrate",
                      "leave [material.substrate] out");
}

void read_stack(const TableReader& root, SynthRecipe& recipe, LoadState& state) {
    if (!root.has("material"))
        return;
    const TableReader material = root.table("material", {"layer", "substrate", "back"});
    refuse_bottoms(material);
    const auto layers = material.tables("layer");
    for (std::size_t k = 0; k < layers.size(); ++k) {
        recipe.stack.layers.push_back(read_layer(*layers[k], root.file(), k, state));
        if (recipe.stack.layers.back().flakes)
            throw_input_error(position_of(root.file(), layers[k]->source()),
                              "synth measures by the model adding, which has no flakes",
                              "leave the flakes out");
    }
}

void read_geometries(const TableReader& root, SynthRecipe& recipe) {
    if (!root.has("geometry")) {
        if (!recipe.stack.layers.empty())
            root.fail("material", "a stack is measured in directions, and none is given",
                      "add [geometry] with theta_i_deg, theta_o_deg and phi_deg");
        return;
    }
    const TableReader reader = root.table("geometry", {"theta_i_deg", "theta_o_deg", "phi_deg"});
    const auto angles = [&](const char* key, double below) {
        const std::vector<double> list =
            numbers_at(reader.required(key), reader.file(), reader.position_of_key(key), key, 0,
                       {.low = 0.0, .high = below, .high_is_allowed = false});
        if (list.empty() || list.size() > most_directions)
            reader.fail(key, fmt::format("{} holds {} angles", key, list.size()),
                        fmt::format("give 1 to {}", most_directions));
        for (std::size_t k = 1; k < list.size(); ++k)
            if (std::find(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(k), list[k]) !=
                list.begin() + static_cast<std::ptrdiff_t>(k))
                reader.fail(key, fmt::format("{} degrees is given twice", list[k]),
                            "give each angle once");
        return list;
    };
    const auto incident = angles("theta_i_deg", 90.0), outgoing = angles("theta_o_deg", 90.0),
               azimuths = angles("phi_deg", 360.0);
    for (const double theta_i : incident)
        for (const double theta_o : outgoing)
            for (const double phi : azimuths)
                recipe.geometries.push_back({theta_i, theta_o, phi});
}

void read_instrument(const TableReader& root, SynthRecipe& recipe, LoadState& state) {
    if (root.has("instrument")) {
        const TableReader reader =
            root.table("instrument", {"excitation_fwhm_nm", "emission_fwhm_nm", "spill",
                                      "second_order", "lamp", "scale", "ceiling"});
        const NumberRange fwhm = NumberRange::within(0.0, 100.0);
        recipe.instrument = {reader.number_or("excitation_fwhm_nm", 0.0, fwhm),
                             reader.number_or("emission_fwhm_nm", 0.0, fwhm),
                             reader.number_or("spill", 0.0, NumberRange::within(0.0, 1.0)),
                             reader.number_or("second_order", 0.0, NumberRange::within(0.0, 1.0))};
        const NumberRange unit{.low = 0.0, .high = 1e12, .low_is_allowed = false};
        recipe.instrument.scale = reader.number_or("scale", 1.0, unit);
        if (reader.has("ceiling"))
            recipe.instrument.ceiling = reader.number("ceiling", unit);
        if (reader.has("lamp"))
            recipe.instrument.lamp =
                read_spectrum_key(reader, "lamp", SpectrumLimits::emission(), state);
    }
    if (root.has("noise")) {
        const TableReader reader =
            root.table("noise", {"read_of_peak", "shot_counts_at_peak", "relative"});
        recipe.noise = {
            reader.number_or("read_of_peak", 0.0, NumberRange::within(0.0, 10.0)),
            reader.number_or("shot_counts_at_peak", 0.0, NumberRange::within(0.0, 1e12)),
            reader.number_or("relative", 0.0, NumberRange::within(0.0, 1.0))};
    }
}

} // namespace

SynthRecipe read_synth_recipe(const std::filesystem::path& file) {
    return synth_recipe_from_table(read_scene_table(file), file);
}

SynthRecipe synth_recipe_from_table(const toml::table& table, const std::filesystem::path& file) {
    LoadState state;
    const TableReader root(table, file.string(), "a recipe",
                           {"emission_nm", "excitation_nm", "reflectance", "fluorophore",
                            "material", "geometry", "instrument", "noise"});
    SynthRecipe recipe;
    if (root.has("emission_nm"))
        recipe.emission = read_grid(root, "emission_nm");
    if (root.has("excitation_nm"))
        recipe.excitation = read_grid(root, "excitation_nm");
    read_fluorophores(root, recipe);
    if (root.has("reflectance"))
        recipe.reflectance =
            read_spectrum_key(root, "reflectance", SpectrumLimits::fraction(), state);
    refuse_too_much_light(root, recipe);
    read_stack(root, recipe, state);
    if (recipe.fluorophores.empty() && !recipe.stack.is_dyed())
        root.fail("fluorophore", "the recipe has 0 fluorophores",
                  fmt::format("give 1 to {} [[fluorophore]], or fluorophores in a layer",
                              most_fluorophores));
    read_geometries(root, recipe);
    read_instrument(root, recipe, state);
    state.warn_outside(std::min(recipe.emission.from_nm, recipe.excitation.from_nm),
                       std::max(recipe.emission.to_nm(), recipe.excitation.to_nm()));
    return recipe;
}

} // namespace reradiant
