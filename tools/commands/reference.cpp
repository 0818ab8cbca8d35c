#include "tools/commands/reference.h"

#include "host/film/display/png.h"
#include "host/scene/document/key_reference.h"
#include "host/scene/document/toml_document.h"
#include "host/scene/toml/scene_table.h"
#include "reradiant/paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <unistd.h>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

constexpr const char* sample_head = R"(
film = { width = 8, height = 8, bands_nm = { from = 400, to = 700, step = 100 } }
camera = { origin = [0, 0, 5], target = [0, 0, 0], up = [0, 1, 0], fov_deg = 35, lens_radius = 0, focus_distance = 5 }
integrator = { max_depth = 8, min_depth = 3 }
)";

/// Together they hold every key, each with a value that it may have.
constexpr const char* samples[] = {
    R"(
light = [
  { type = "rectangle", group = "day", center = [0, 5, 0], edge_u = [1, 0, 0], edge_v = [0, 0, 1], radiance = { nm = [400, 700], value = [1, 2] } },
  { type = "sphere", center = [0, 5, 0], radius = 1, radiance = { illuminant = "D65", scale = 1 } },
  { type = "point", position = [0, 5, 0], intensity = { blackbody_kelvin = 3000, scale = 1 } },
  { type = "directional", direction = [0, -1, 0], angle_deg = 1, irradiance = { line_nm = 405, width_nm = 2, scale = 1 } },
  { type = "rectangle", center = [0, 5, 0], target = [0, 0, 0], size = [1, 1], radiance = { product = [{ illuminant = "D65" }, 0.5], scale = 1, min = 0, max = 9 } },
  { type = "disk", center = [0, 5, 0], normal = [0, -1, 0], radius = 1, radiance = { sum = [1, 2], scale = 1 } },
  { type = "disk", center = [0, 5, 0], target = [0, 0, 0], radius = 1, radiance = 1 },
  { type = "mesh", file = "mesh.obj", scale = 2, rotate_deg = [0, 90, 0], translate = [0, 5, 0], radiance = 1 },
  { type = "spot", position = [0, 5, 0], target = [0, 0, 0], cone_deg = 30, falloff_deg = 5, intensity = 1 },
  { type = "environment", radiance = { gaussian_nm = 500, sigma_nm = 20, scale = 1 } }]
shape = [
  { type = "sphere", center = [0, 0, 0], radius = 1, material = "a" },
  { type = "rectangle", center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, 1], material = "a" },
  { type = "disk", center = [0, 0, 0], normal = [0, 1, 0], radius = 1, material = "a" },
  { type = "mesh", file = "mesh.obj", transform = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], face_normals = false, smooth_normals = true, flip_v = false, material = "a" },
  { type = "cylinder", from = [0, 0, 0], to = [0, 1, 0], radius = 1, material = "a" },
  { type = "instance", file = "mesh.obj", scale = [1, 2, 1], rotate_deg = [0, 90, 0], translate = [0, 5, 0], face_normals = true, smooth_normals = false, flip_v = false, material = "a" },
  { type = "heightfield", file = "grey.png", center = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 0, 1], height = 1, material = "a" }]
texture = [
  { name = "n", type = "noise", space = "world", size = 1, levels = 2, low = 0, high = 1, seed = 0, tilt_deg = 5, octaves = 1, sharpness = 1 },
  { name = "v", type = "voronoi", space = "world", share = 0.5, seed = 1, tilt_deg = 0 },
  { name = "c", type = "checker", space = "world" },
  { name = "i", type = "image", space = "uv", file = "grey.png", normal_map = false, linear = true }]
[[material]]
name = "a"
model = "auto"
normal = { texture = "n" }
opacity = { texture = "c" }
mix = { with = "b", weight = { texture = "c" } }
layer = [
  { ior = 1.5, roughness_deg = 5, distribution = "ggx", scattering = "multiple", thickness = { texture = "c", low = 0, high = 1 }, absorption = 0, scattering_coefficient = 0, anisotropy = 0, film = { thickness_nm = 300, ior = 1.4 } },
  { ior = 1.5, alpha = 0.1, flakes = { coverage = 0.1, metal = "silver", alpha = 0.1, distribution = "ggx", scattering = "single", film = { thickness_nm = 300, ior = 1.4 } } },
  { ior = 1.5, fluorophores = [{ absorption = { gaussian_nm = 450, sigma_nm = 20 }, concentration = 1, emission = { gaussian_nm = 600, sigma_nm = 20 }, quantum_yield = 0.9 }, { absorption = 0.1, shares = { file = "synthetic-orange.csv" } }] },
  { ior = 1.5, flakes = { coverage = 0.1, ior = 0.2, kappa = 3, roughness_deg = 5 } }]
substrate = { type = "lambert", reflectance = { rgb = [0.5, 0.5, 0.5] } }
[[material]]
name = "b"
substrate = { type = "conductor", ior = 0.2, kappa = 3, alpha = 0.1 }
)",
    R"(
include = ["more.toml"]
light = [{ type = "sky", sun_elevation_deg = 40, sun_azimuth_deg = 0, sun = true, turbidity = 3, ground_albedo = 0.2, ozone_cm = 0.3, water_cm = 1, scale = 1 }]
)",
    R"(
light = [{ type = "environment", file = "grey.png", rotation_deg = 0, radiance = { illuminant = "D65" } }]
material = [
  { name = "a", preset = "red-lacquer" },
  { name = "b", substrate = { type = "oren-nayar", sigma = 0.3, reflectance = { file = "grey.csv" } } },
  { name = "c", substrate = { type = "lambert", reradiation = { file = "synthetic-orange.csv", strength = 0.5 } } },
  { name = "d", substrate = { type = "lambert", reradiation = { reflectance = 0.1, fluorophores = [{ excitation = 0.1, concentration = 1, emission = { gaussian_nm = 600, sigma_nm = 20 }, quantum_yield = 0.9 }] } } },
  { name = "e", substrate = { type = "lambert", thickness = 1, backing = 0.5, pigments = [{ absorption = 1, scattering = 1, concentration = 1 }], dyes = [{ absorption = { gaussian_nm = 450, sigma_nm = 20 }, emission = { gaussian_nm = 600, sigma_nm = 20 }, quantum_yield = 0.9, concentration = 1 }] } },
  { name = "f", substrate = { type = "conductor", metal = "gold", roughness_deg = 5, distribution = "ggx", scattering = "single", film = { thickness_nm = 300, ior = 1.4 } } },
  { name = "g", substrate = { type = "oren-nayar", sigma = 0.3, thickness = 1, backing = 0.5, pigments = [{ absorption = 1, scattering = 1, concentration = 1 }], dyes = [{ absorption = { gaussian_nm = 450, sigma_nm = 20 }, emission = { gaussian_nm = 600, sigma_nm = 20 }, quantum_yield = 0.9, concentration = 1 }] } },
  { name = "h", substrate = { type = "oren-nayar", sigma = 0.3, reradiation = { file = "synthetic-orange.csv" } } },
  { name = "i", layer = [{ ior = 1.5 }], substrate = { type = "none" }, back = { alpha = 0.1, distribution = "ggx", scattering = "multiple" } },
  { name = "j", layer = [{ ior = 1.5 }], substrate = { type = "none" }, back = { roughness_deg = 5 } }]
)"};

/// A folder with the files that the samples name, for as long as this lives.
class SampleFiles {
public:
    SampleFiles()
        : folder(temporary_directory() / fmt::format("reradiant-reference-{}", ::getpid())) {
        fs::create_directories(folder);
        std::ofstream(folder / "mesh.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        std::ofstream(folder / "more.toml");
        std::ofstream(folder / "grey.csv") << "nm,value\n380,0.5\n780,0.5\n";
        write_png(folder / "grey.png", 2, 2, std::vector<std::uint8_t>(12, 128), true);
    }
    ~SampleFiles() {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
    SampleFiles(const SampleFiles&) = delete;
    SampleFiles& operator=(const SampleFiles&) = delete;

    const fs::path folder;
};

std::string kind_of(const KeyReference::Table& table, const std::string& key) {
    if (const auto found = table.about.find(key); found != table.about.end())
        return found->second.kind;
    const std::size_t type = table.name.rfind('(');
    if (key == "type" &&
        type != std::string::npos) // read by type_of_table, before the reader is made
        return fmt::format("\"{}\"", table.name.substr(type + 1, table.name.size() - type - 2));
    throw std::logic_error(fmt::format("no sample holds {} of {}", key, table.name));
}

std::string markdown_of(const KeyReference::Table& table) {
    std::string text = fmt::format(
        "\n## {}\n\n| key | takes | default | meaning |\n| --- | --- | --- | --- |\n", table.name);
    for (const std::string& key : table.keys) {
        const std::string meaning = reference_text(table.name, key);
        if (meaning.empty())
            throw std::logic_error(
                fmt::format("nothing is written about {} of {}", key, table.name));
        const auto about = table.about.find(key);
        text += fmt::format("| `{}` | {} | {} | {} |\n", key, kind_of(table, key),
                            about == table.about.end() ? "" : about->second.otherwise, meaning);
    }
    return text;
}

constexpr const char* introduction =
    R"(# Scene and material files

Made by `reradiant validate --reference` from what the loader asks for. A scene file holds the tables
`[film]`, `[camera]`, `[integrator]`, `[[light]]`, `[[shape]]`, `[[material]]`, `[[texture]]`; a material
file holds one `[material]`. `include = ["materials.toml"]` at the head of a scene adds the materials and textures
of other files, which may include others. Unknown keys and wrong values are errors with line and column.

SPECTRUM is a number, one of the tables "SPECTRUM by ..." below, or a list of them, which are added. In
materials it may be `{ texture = "name", low = ..., high = ... }`, also where "number or texture" stands.
)";

} // namespace

std::string format_reference() {
    const SampleFiles files;
    const fs::path file = files.folder / "sample.toml";
    KeyReference reference;
    for (const char* sample : samples)
        scene_from_table(parse_toml(file.string(), std::string(sample_head) + sample), file);
    if (const auto missing = reference.missing_types(); !missing.empty())
        throw std::logic_error(fmt::format("no sample has the type {}", fmt::join(missing, ", ")));
    std::string text = introduction;
    for (const KeyReference::Table& table : reference.tables())
        if (table.name != "a scene" && table.name != "a material file" &&
            table.name != "a file of materials" &&
            !table.name.starts_with("[material]")) // as [[material]]
            text += markdown_of(table);
    return text;
}

} // namespace reradiant
