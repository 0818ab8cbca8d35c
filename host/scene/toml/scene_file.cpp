#include "reradiant/scene_file.h"

#include "host/base/logging.h"
#include "host/scene/lights/idle_lamps.h"
#include "host/scene/mitsuba/mitsuba_import.h"
#include "host/scene/model/joined_materials.h"
#include "host/scene/model/matrix_grids.h"
#include "host/scene/model/surface_builder.h"
#include "host/scene/model/textured_value.h"
#include "host/scene/toml/included_files.h"
#include "host/scene/toml/material_reader.h"
#include "host/scene/toml/scene_parts.h"
#include "host/scene/toml/scene_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr int MAX_FILM_SIZE = 65536;
constexpr int MAX_PATH_DEPTH = 10000;

FilmSettings read_film(const TableReader& reader) {
    FilmSettings film;
    film.width = reader.integer("width", 1, MAX_FILM_SIZE);
    film.height = reader.integer("height", 1, MAX_FILM_SIZE);
    if (!reader.has("bands_nm"))
        return film;
    const TableReader bands = reader.table("bands_nm", {"from", "to", "step"});
    const NumberRange wavelength = NumberRange::within(1.0, 1e5);
    const double from = bands.number("from", wavelength), to = bands.number("to", wavelength);
    const double step = bands.number("step", {.low = 0.0, .low_is_allowed = false});
    try {
        film.bands = grid_from_range(from, to, step);
    } catch (const std::invalid_argument& error) {
        reader.fail("bands_nm", error.what(),
                    "from and to are centres, a whole number of steps apart");
    }
    return film;
}

Camera read_camera(const TableReader& reader) {
    Camera camera;
    camera.origin = reader.vector("origin");
    camera.target = reader.vector("target");
    camera.up = reader.vector_or("up", camera.up);
    camera.fov_deg = reader.number_or("fov_deg", camera.fov_deg, NumberRange::between(0.0, 180.0));
    const Vector3 view{camera.target[0] - camera.origin[0], camera.target[1] - camera.origin[1],
                       camera.target[2] - camera.origin[2]};
    const double distance = vector_length(view), up_length = vector_length(camera.up);
    if (!(distance > 0.0))
        reader.fail("target", "the camera is at its target", "move origin or target");
    if (!(up_length > 0.0))
        reader.fail("up", "up is zero", "give a direction");
    // sin of the angle between the two; beneath this the picture's roll is rounding noise.
    if (!(vector_length(vector_cross(view, camera.up)) > 1e-6 * distance * up_length))
        reader.fail(reader.has("up") ? "up" : "target", "up is parallel to the view direction",
                    "give an up that points elsewhere");
    camera.lens_radius =
        reader.number_or("lens_radius", 0.0, NumberRange::within(0.0, MAX_COORDINATE));
    camera.focus_distance =
        reader.number_or("focus_distance", distance,
                         {.low = 0.0, .high = 2.0 * MAX_COORDINATE, .low_is_allowed = false});
    return camera;
}

IntegratorSettings read_integrator(const TableReader& reader) {
    IntegratorSettings integrator;
    integrator.max_depth = reader.integer_or("max_depth", integrator.max_depth, 1, MAX_PATH_DEPTH);
    integrator.min_depth = reader.integer_or("min_depth", integrator.min_depth, 0, MAX_PATH_DEPTH);
    return integrator;
}

std::map<std::string, int> read_materials(const TableReader& root, Scene& scene, LoadState& state) {
    std::map<std::string, int> indices;
    const IncludedFiles included(root, state);
    TextureScope textures;
    for (const TableReader& file : included.readers())
        textures.add(file, state);
    state.texture_scope = &textures;
    SurfaceBuilder builder;
    for (const TableReader& file : included.readers())
        for (const toml::table* table : file.tables("material")) {
            MaterialReading reading =
                read_material(*table, file.file(), MaterialPlace::Scene, state);
            if (!indices.emplace(reading.representative.name, static_cast<int>(indices.size()))
                     .second)
                throw_input_error(
                    position_of(file.file(), table->find("name")->first.source()),
                    fmt::format("two materials are called \"{}\"", reading.representative.name),
                    "give each its own name");
            builder.add(std::move(reading));
        }
    builder.finish(indices, scene, state);
    state.texture_scope = nullptr;
    scene.textures = std::move(state.textures);
    return indices;
}

void warn_outside_bands(const Scene& scene, const LoadState& state) {
    const bool fluorescent = std::any_of(scene.materials.begin(), scene.materials.end(),
                                         [](const Material& m) { return m.is_fluorescent(); });
    const auto range = scene.film.bands
                           ? std::array{scene.film.bands->from_nm, scene.film.bands->to_nm()}
                           : default_range_nm(fluorescent);
    state.warn_outside(range[0], range[1]);
}

/// The wavelengths that a material by itself is used at.
std::array<double, 2> used_range_nm(const Material& material,
                                    const std::optional<WavelengthGrid>& bands) {
    const std::optional<WavelengthGrid> grid = bands ? bands : common_grid(matrices_of(material));
    return grid ? std::array{grid->from_nm, grid->to_nm()}
                : default_range_nm(material.is_fluorescent());
}

/// The sun of a sky, which is of the sky's group.
struct Sun {
    Light light;
    SourcePosition place;
    std::string group;
};

/// Constant environments add up to one; an image is looked up alone. The i-th light is that of the
/// i-th table; the suns of skies follow after all. Returns the place of each light.
std::vector<SourcePosition> read_all_lights(const TableReader& root, Scene& scene,
                                            LoadState& state) {
    const auto tables = root.tables("light");
    std::vector<SourcePosition> places;
    std::vector<Sun> suns;
    int skies = 0, images = 0;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const SourcePosition at = position_of(root.file(), *tables[i]);
        std::string& group = scene.light_groups.emplace_back();
        std::vector<Light> read = read_lights(*tables[i], root.file(), i, state, group);
        if (const auto* sky = std::get_if<EnvironmentLight>(&read.front())) {
            ++skies;
            images += sky->image >= 0 ? 1 : 0;
        }
        if (images > 0 && skies > 1)
            throw_input_error(at, "an environment image stands beside another environment",
                              "put both into one image");
        scene.lights.push_back(std::move(read.front()));
        places.push_back(at);
        if (read.size() > 1)
            suns.push_back({std::move(read[1]), at, group});
    }
    for (Sun& sun : suns) {
        scene.lights.push_back(std::move(sun.light));
        scene.light_groups.push_back(std::move(sun.group));
        places.push_back(sun.place);
    }
    return places;
}

void warn_of_idle_lamps(const Scene& scene, const std::vector<SourcePosition>& places,
                        LoadState& state) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (const std::string reason = idle_reason(scene.lights[i], scene); !reason.empty())
            state.warn(places[i], fmt::format("the light lights nothing: {}", reason));
}

Scene read_scene(const toml::table& table, const std::filesystem::path& file, LoadState& state) {
    const TableReader root(
        table, file.string(), "a scene",
        {"film", "camera", "integrator", "light", "shape", "material", "texture", "include"});
    Scene scene;
    scene.file = file;
    scene.film = read_film(root.table("film", {"width", "height", "bands_nm"}));
    scene.camera = read_camera(root.table(
        "camera", {"origin", "target", "up", "fov_deg", "lens_radius", "focus_distance"}));
    if (root.has("integrator"))
        scene.integrator = read_integrator(root.table("integrator", {"max_depth", "min_depth"}));
    const std::vector<SourcePosition> light_places = read_all_lights(root, scene, state);
    const auto materials = read_materials(root, scene, state);
    const auto shapes = root.tables("shape");
    for (std::size_t i = 0; i < shapes.size(); ++i)
        scene.shapes.push_back(read_shape(*shapes[i], root.file(), i, materials, state));
    scene.images = std::move(state.images);
    warn_outside_bands(scene, state);
    warn_of_idle_lamps(scene, light_places, state);
    scene.hash = state.digest();
    return scene;
}

} // namespace

Scene load_scene(const std::filesystem::path& file) {
    if (is_mitsuba_scene(file))
        return scene_from_table(mitsuba_scene_table(file, file.parent_path()), file);
    LoadState state;
    const std::string text = read_file(file, {file.string()}, MAX_TOML_BYTES);
    state.add_to_digest(text);
    Scene scene = read_scene(parse_toml(file.string(), text), file, state);
    join_layers(scene);
    return scene;
}

Scene scene_from_table(const toml::table& table, const std::filesystem::path& file) {
    Scene scene = scene_as_written(table, file);
    join_layers(scene);
    return scene;
}

Scene scene_as_written(const toml::table& table, const std::filesystem::path& file) {
    LoadState state;
    std::ostringstream text;
    text << toml::toml_formatter(table);
    state.add_to_digest(text.str());
    return read_scene(table, file, state);
}

toml::table read_scene_table(const std::filesystem::path& file) {
    return parse_toml(file.string(), read_file(file, {file.string()}, MAX_TOML_BYTES));
}

Material load_material(const std::filesystem::path& file,
                       const std::optional<WavelengthGrid>& bands) {
    return material_from_table(read_scene_table(file), file, bands);
}

Material material_from_table(const toml::table& table, const std::filesystem::path& file,
                             const std::optional<WavelengthGrid>& bands) {
    LoadState state;
    const TableReader root(table, file.string(), "a material file", {"material", "texture"});
    const toml::node& node = root.required("material");
    if (node.is_array())
        root.fail("material", "material is an array of tables",
                  "a material file holds one [material]; [[material]] stands in scenes");
    TextureScope textures(root, state);
    state.texture_scope = &textures;
    MaterialReading reading = read_material(root.plain_table("material"), root.file(),
                                            MaterialPlace::MaterialFile, state);
    if (!reading.textures.empty())
        logging::info("{}: textured values are taken at the middle of their textures",
                      file.string());
    if (!reading.mixed_with.empty())
        logging::info("{}: the mixture with \"{}\" is left out", file.string(), reading.mixed_with);
    Material material = std::move(reading.representative);
    const std::array<double, 2> range = used_range_nm(material, bands);
    state.warn_outside(range[0], range[1]);
    join_layers(material);
    return material;
}

} // namespace reradiant
