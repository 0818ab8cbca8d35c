#include "host/scene/toml/stack_reader.h"

#include "host/scene/model/textured_value.h"
#include "host/scene/toml/fluorophore_reader.h"
#include "host/scene/toml/spectrum_reader.h"
#include "host/spectral/text/number_table.h"
#include "reradiant/paths.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr double MAX_FILM_NM = 1e5;

/// `Roughness` says how rough a surface is and how its facets scatter light. An interface, a
/// conductor and a flake have the same keys for it.
struct Roughness {
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0;
    Scattering scattering = Scattering::Multiple;
};
const std::vector<std::string> ROUGHNESS_KEYS{"roughness_deg", "alpha", "distribution",
                                              "scattering"};

/// Reads the width from `roughness_deg` or `alpha`; returns 0 when neither is given.
double read_alpha(const TableReader& reader, Distribution distribution, LoadState& state) {
    if (reader.has("roughness_deg") && reader.has("alpha"))
        reader.fail("alpha", "both roughness_deg and alpha are given", "give one of them");
    if (reader.has("alpha"))
        return read_number_key(reader, "alpha", NumberRange::within(0.0, 1.0), state);
    const double degrees = read_number_key_or(
        reader, "roughness_deg", 0.0, {.low = 0.0, .high = 90.0, .high_is_allowed = false}, state);
    const double alpha = alpha_from_roughness_deg(distribution, degrees);
    if (!(alpha <= 1.0))
        reader.fail("roughness_deg",
                    fmt::format("roughness_deg = {} is a width alpha of {}", degrees, alpha),
                    "alpha must be at most 1");
    return alpha;
}

Roughness read_roughness(const TableReader& reader, LoadState& state) {
    Roughness roughness;
    if (reader.has("distribution")) {
        const std::string name = reader.choice("distribution", {"blinn", "beckmann", "ggx"});
        roughness.distribution = name == "blinn"      ? Distribution::Blinn
                                 : name == "beckmann" ? Distribution::Beckmann
                                                      : Distribution::Ggx;
    }
    roughness.alpha = read_alpha(reader, roughness.distribution, state);
    if (reader.has("scattering") && reader.choice("scattering", {"multiple", "single"}) == "single")
        roughness.scattering = Scattering::Single;
    return roughness;
}

std::optional<ThinFilm> read_film(const TableReader& owner, LoadState& state) {
    if (!owner.has("film"))
        return std::nullopt;
    const TableReader reader = owner.table("film", {"thickness_nm", "ior"});
    ThinFilm film;
    film.thickness_nm =
        read_number_key(reader, "thickness_nm", NumberRange::within(0.0, MAX_FILM_NM), state);
    film.ior = read_spectrum_key(reader, "ior", SpectrumLimits::positive(MAX_IOR), state);
    return film;
}

/// n and kappa of a table in spectra/metals: columns nm, n, k.
void read_metal(const TableReader& reader, Conductor& conductor, LoadState& state) {
    const std::string name = reader.text("metal");
    const auto known = metal_names();
    if (std::find(known.begin(), known.end(), name) == known.end())
        reader.fail("metal", fmt::format("no metal is called \"{}\"", name),
                    fmt::format("there are: {}; or give ior and kappa", fmt::join(known, ", ")));
    for (const char* key : {"ior", "kappa"})
        if (reader.has(key))
            reader.fail(key, fmt::format("both metal and {} are given", key),
                        "a metal has both ior and kappa");
    const SourcePosition at = reader.position_of_key("metal");
    const fs::path file = spectra_directory() / "metals" / (name + ".csv");
    state.resolve_and_digest(file.string(), at);
    NumberTable table = read_number_table(file, 3);
    conductor.ior = Spectrum::table(table.columns[0], std::move(table.columns[1]));
    conductor.kappa = Spectrum::table(std::move(table.columns[0]), std::move(table.columns[2]));
    state.track(conductor.kappa, at, fmt::format("the metal \"{}\"", name));
}

std::optional<Flakes> read_flakes(const TableReader& layer, LoadState& state) {
    if (!layer.has("flakes"))
        return std::nullopt;
    std::vector<std::string> keys = conductor_keys();
    keys.push_back("coverage");
    const TableReader reader = layer.table("flakes", keys);
    Flakes flakes;
    flakes.coverage = read_number_key(reader, "coverage", NumberRange::within(0.0, 1.0), state);
    flakes.reflector = read_conductor(reader, state);
    return flakes;
}

} // namespace

std::vector<std::string> metal_names() {
    std::vector<std::string> names;
    std::error_code ignored;
    for (fs::directory_iterator entry(spectra_directory() / "metals", ignored), end; entry != end;
         entry.increment(ignored))
        if (entry->path().extension() == ".csv")
            names.push_back(entry->path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

const std::vector<std::string>& conductor_keys() {
    static const std::vector<std::string> keys = [] {
        std::vector<std::string> all{"ior", "kappa", "metal", "film"};
        all.insert(all.end(), ROUGHNESS_KEYS.begin(), ROUGHNESS_KEYS.end());
        return all;
    }();
    return keys;
}

Conductor read_conductor(const TableReader& reader, LoadState& state) {
    constexpr const char* remedy = "give both ior and kappa, or metal = \"gold\"";
    Conductor conductor;
    if (reader.has("metal")) {
        read_metal(reader, conductor, state);
    } else {
        if (reader.has("ior") && !reader.has("kappa"))
            reader.fail("ior", "the metal has no kappa", remedy);
        if (!reader.has("ior"))
            reader.fail(reader.has("kappa") ? "kappa" : "type", "the metal has no ior", remedy);
        conductor.ior = read_spectrum_key(reader, "ior", SpectrumLimits::positive(MAX_IOR), state);
        conductor.kappa = read_spectrum_key(reader, "kappa", {.high = MAX_IOR}, state);
    }
    const Roughness roughness = read_roughness(reader, state);
    conductor.distribution = roughness.distribution;
    conductor.alpha = roughness.alpha;
    conductor.scattering = roughness.scattering;
    conductor.film = read_film(reader, state);
    return conductor;
}

Layer read_layer(const toml::table& table, const std::string& file, std::size_t index,
                 LoadState& state) {
    std::vector<std::string> keys{"ior",          "thickness",  "absorption",
                                  "fluorophores", "anisotropy", "scattering_coefficient",
                                  "film",         "flakes"};
    keys.insert(keys.end(), ROUGHNESS_KEYS.begin(), ROUGHNESS_KEYS.end());
    const TableReader reader(table, file, fmt::format("[[material.layer]] {}", index), keys);
    Layer layer;
    layer.ior = read_spectrum_key(reader, "ior", SpectrumLimits::positive(MAX_IOR), state);
    const Roughness roughness = read_roughness(reader, state);
    layer.distribution = roughness.distribution;
    layer.alpha = roughness.alpha;
    layer.scattering = roughness.scattering;
    layer.thickness =
        read_number_key_or(reader, "thickness", 1.0, NumberRange::within(0.0, 1e18), state);
    if (reader.has("absorption"))
        layer.absorption =
            read_spectrum_key(reader, "absorption", SpectrumLimits::emission(), state);
    layer.dyes = read_slab_dyes(reader, state);
    if (reader.has("scattering_coefficient"))
        layer.scattering_coefficient =
            read_spectrum_key(reader, "scattering_coefficient", SpectrumLimits::emission(), state);
    layer.anisotropy =
        read_number_key_or(reader, "anisotropy", 0.0, NumberRange::between(-1.0, 1.0), state);
    layer.film = read_film(reader, state);
    layer.flakes = read_flakes(reader, state);
    return layer;
}

LowerFace read_lower_face(const TableReader& material, LoadState& state) {
    if (!material.has("back"))
        return {};
    const Roughness roughness = read_roughness(material.table("back", ROUGHNESS_KEYS), state);
    return {roughness.distribution, roughness.alpha, roughness.scattering};
}

} // namespace reradiant
