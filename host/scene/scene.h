#pragma once

#include "host/error.h"
#include "host/layers/stack.h"
#include "host/spectral/grid.h"
#include "host/spectral/reradiation.h"
#include "host/spectral/spectrum.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace reradiant {

using Vector3 = std::array<double, 3>;

struct FilmSettings {
    int width = 0, height = 0;
    std::optional<WavelengthGrid> bands; ///< empty: chosen by what the scene holds (DESIGN 1)
};

/// Right-handed; fov is vertical; lens_radius 0 is a pinhole.
struct Camera {
    Vector3 origin{}, target{}, up{0, 1, 0};
    double fov_deg = 35.0;
    double lens_radius = 0.0;
    double focus_distance = 1.0;
};

struct IntegratorSettings {
    int max_depth = 8; ///< surface interactions along a path; 1 = direct light only
    int min_depth = 3; ///< before Russian roulette
};

/// Emits radiance on the side of cross(edge_u, edge_v).
struct RectangleLight {
    Vector3 center{}, edge_u{}, edge_v{};
    Spectrum radiance;
};
struct SphereLight {
    Vector3 center{};
    double radius = 1.0;
    Spectrum radiance;
};
/// intensity in W/sr per nm
struct PointLight {
    Vector3 position{};
    Spectrum intensity;
};
/// Light travels along `direction`; irradiance on a plane facing it, W/m^2 per nm.
struct DirectionalLight {
    Vector3 direction{};
    Spectrum irradiance;
};
struct EnvironmentLight {
    Spectrum radiance;
};
using Light =
    std::variant<RectangleLight, SphereLight, PointLight, DirectionalLight, EnvironmentLight>;

/// The emission spectrum of any light (radiance, intensity or irradiance).
const Spectrum& light_spectrum(const Light& light);

/// What happens at the bottom of a stack. Reflectance alone, or a matrix, or fluorophores.
struct Substrate {
    Spectrum reflectance; ///< the non-fluorescent part; for a matrix: its diagonal
    std::optional<ReradiationMatrix> matrix; ///< already repaired for rendering
    std::vector<Fluorophore> fluorophores;

    bool is_fluorescent() const;
    /// Own grid of a matrix (its union of emission and excitation when the steps agree), if any.
    std::optional<WavelengthGrid> own_grid() const;
    /// Fluorescent part on cells, diagonal = within-cell fluorescence only (reflectance left
    /// out): square, rows = emission. See reradiation.h.
    Eigen::MatrixXd fluorescence_on(const WavelengthGrid& cells) const;
    /// Range of wavelengths that can excite, and range that can be emitted; {0, 0} if none.
    std::array<double, 2> excitation_range_nm() const;
    std::array<double, 2> emission_range_nm() const;
};

enum class Model { Auto, Adding, WeidlichWilkie, Walk };
Model model_from_name(const std::string& name); ///< std::invalid_argument lists the names
const char* model_name(Model model);

struct Material {
    std::string name;
    Model model = Model::Auto;
    LayerStack stack; ///< air side first; may be empty (bare substrate)
    Substrate substrate;
};

struct SphereShape {
    Vector3 center{};
    double radius = 1.0;
};
struct RectangleShape {
    Vector3 center{}, edge_u{}, edge_v{};
};
struct DiskShape {
    Vector3 center{}, normal{};
    double radius = 1.0;
};
/// Triangles; positions xyz xyz ..., 3 indices a triangle, normals empty or one a vertex.
struct MeshShape {
    std::vector<float> positions, normals, texture_coordinates;
    std::vector<std::uint32_t> indices;
    std::filesystem::path file;
};
struct Shape {
    std::variant<SphereShape, RectangleShape, DiskShape, MeshShape> geometry;
    int material = 0; ///< index into Scene::materials
};

struct Scene {
    std::filesystem::path file;
    FilmSettings film;
    Camera camera;
    IntegratorSettings integrator;
    std::vector<Light> lights;
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    std::string hash; ///< hex digest of the scene file and of every file it names
};

/// Reads a scene file with everything it names (INTERFACE, "Scene and material files"). Unknown
/// keys, wrong types and lengths, out-of-range numbers and unreadable references throw an input
/// Error at their place. Warnings go to the log.
Scene load_scene(const std::filesystem::path& file);

/// Names that `preset = "..."` takes, sorted: the files of spectra/materials.
std::vector<std::string> preset_names();

/// Reads a MATERIAL.toml with one [material].
Material load_material(const std::filesystem::path& file);

} // namespace reradiant
