#pragma once

#include "reradiant/error.h"
#include "reradiant/fluorophore.h"
#include "reradiant/layer_stack.h"
#include "reradiant/spectrum.h"
#include "reradiant/wavelength_grid.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace reradiant {

struct ReradiationMatrix;

using Vector3 = std::array<double, 3>;

struct FilmSettings {
    int width = 0, height = 0;
    std::optional<WavelengthGrid> bands; ///< empty: chosen by what the scene holds
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

struct SphereShape {
    Vector3 centre{};
    double radius = 1.0;
};
struct RectangleShape {
    Vector3 centre{}, edge_u{}, edge_v{};
};
struct DiskShape {
    Vector3 centre{}, normal{};
    double radius = 1.0;
};
/// Triangles; positions xyz xyz ..., 3 indices a triangle, normals empty or one a vertex.
struct MeshShape {
    std::vector<float> positions, normals, texture_coordinates;
    std::vector<std::uint32_t> indices;
    std::filesystem::path file;
};
/// An open tube from one end to the other; disks close it.
struct CylinderShape {
    Vector3 from{}, to{};
    double radius = 1.0;
};
/// A mesh that other shapes may hold, too, moved by the upper three rows of a matrix.
struct MeshInstance {
    std::shared_ptr<const MeshShape> mesh;
    std::array<double, 12> transform{};
};

/// Emits radiance on the side of cross(edge_u, edge_v).
struct RectangleLight {
    Vector3 centre{}, edge_u{}, edge_v{};
    Spectrum radiance;
};
struct SphereLight {
    Vector3 centre{};
    double radius = 1.0;
    Spectrum radiance;
};
/// Emits radiance on the side of its normal.
struct DiskLight {
    Vector3 centre{}, normal{};
    double radius = 1.0;
    Spectrum radiance;
};
/// Every triangle emits radiance on the side of cross(second - first corner, third - first).
struct MeshLight {
    MeshShape mesh;
    Spectrum radiance;
};
/// intensity in W/sr per nm
struct PointLight {
    Vector3 position{};
    Spectrum intensity;
};
/// A point light within cone_deg of its axis: its intensity holds up to cone_deg - falloff_deg, and
/// falls from there to 0 by s^2 (3 - 2 s), s linear in the cosine (as in pbrt-v4's SpotLight).
struct SpotLight {
    Vector3 position{}, direction{};
    double cone_deg = 30.0; ///< half angle, up to 180
    double falloff_deg = 5.0;
    Spectrum intensity;
};
/// Light travels along `direction`; irradiance on a plane facing it, W/m^2 per nm. It comes from
/// all directions of a cone of full angle angle_deg alike, below 180 degrees; what else is far away
/// does not shine through that disk. 0: from one direction.
struct DirectionalLight {
    Vector3 direction{};
    Spectrum irradiance;
    double angle_deg = 0.0;
};
/// Constant, or with an image: radiance times the texel's colour, rgb made into a spectrum of
/// radiance (see rgb_emission in reradiant/colour.h). Latitude-longitude: the top row
/// looks along +y, the middle column along -z, columns to its right towards +x; turned right-handed
/// about +y by rotation_deg (90: the middle column looks along -x).
struct EnvironmentLight {
    Spectrum radiance;
    int image = -1; ///< index into Scene::images
    double rotation_deg = 0.0;
    /// What red, green and blue of the image stand for, times `radiance`; empty: the basis of
    /// rgb_emission.
    std::vector<Spectrum> primaries = {};
};
using Light = std::variant<RectangleLight, SphereLight, PointLight, DirectionalLight,
                           EnvironmentLight, SpotLight, DiskLight, MeshLight>;

/// The emission spectrum of any light (radiance, intensity or irradiance).
const Spectrum& light_spectrum(const Light& light);

/// oren-nayar: Oren and Nayar 1994, qualitative form, sigma in radians. none: the stack is a sheet
/// in air and has a lower face (LayerStack).
enum class SubstrateType { Lambert, OrenNayar, Conductor, None };

/// A `Substrate` is the bottom of a stack. It has a reflectance alone, or a matrix, or
/// fluorophores; a conductor has none of them. Pigments by Kubelka-Munk arrive here as reflectance
/// and matrix.
struct Substrate {
    SubstrateType type = SubstrateType::Lambert;
    double sigma = 0.0; ///< oren-nayar
    Conductor conductor;
    int reflectance_image = -1; ///< index into Scene::textures (image): its rgb, made into a
                                ///< reflectance, multiplies `reflectance`
    Spectrum reflectance;       ///< the non-fluorescent part; for a matrix: its diagonal
    /// Already repaired for rendering (reradiant/reradiation.h); null: there is none.
    std::shared_ptr<const ReradiationMatrix> matrix;
    std::vector<Fluorophore> fluorophores;

    bool is_fluorescent() const;
    /// Own grid of a matrix (its union of emission and excitation when the steps agree), if any.
    std::optional<WavelengthGrid> own_grid() const;
    /// Range of wavelengths that can excite, and range that can be emitted; {0, 0} if none.
    std::array<double, 2> excitation_range_nm() const;
    std::array<double, 2> emission_range_nm() const;
};

enum class Model { Auto, Adding, WeidlichWilkie, Walk };
Model model_from_name(const std::string& name); ///< std::invalid_argument lists the names
const char* model_name(Model model);

/// Linear rgb (sRGB primaries) or grey, top row first.
struct Image {
    std::filesystem::path file;
    int width = 0, height = 0;
    std::vector<float> rgb; ///< 3 * width * height
};

/// A texture gives a number t in 0..1 at every point of a surface (and, for flakes, a normal). The
/// material decides, by its variants, what t stands for.
enum class TextureType { Noise, Voronoi, Checker, Image };
/// A `TextureSpace` says where a texture is looked up: in space (world units) or in the u, v of a
/// shape.
enum class TextureSpace { World, Uv };
struct Texture {
    std::string name;
    TextureType type = TextureType::Noise;
    TextureSpace space = TextureSpace::World;
    double size = 0.1;    ///< of a noise lattice cell, a flake, a square, an image tile
    int octaves = 4;      ///< noise
    double tilt_deg = 0;  ///< voronoi, noise: standard deviation of the normals' tilt
    double share = 0;     ///< voronoi: share of flakes with t = 1, the rest 0; 0: t is uniform
    double sharpness = 1; ///< noise: contrast about 0.5, 1 = as it is
    int image = -1;       ///< index into Scene::images
    bool is_normal_map = false; ///< image of tangent-space normals
    int levels = 8; ///< steps that continuous parameters are tabulated in; 2 for a checker
    unsigned seed = 0;
};

/// A `Surface` is what a shape refers to: one material, or one material per combination of texture
/// levels, or a mixture. A point picks a level of each texture at random between the two nearest
/// (linear interpolation in expectation).
struct Surface {
    std::string name;
    int first_material = 0;    ///< into Scene::materials; the last texture runs fastest
    std::vector<int> textures; ///< into Scene::textures, at most 3; levels are theirs
    int normal_texture = -1;   ///< perturbs the shading normal
    int mixed_with = -1;       ///< another surface, or none; mixtures may not go round in circles
    double mix_weight = 0.0;   ///< share of `mixed_with`
    int mix_texture = -1;      ///< its t replaces mix_weight
    /// Share of rays that the surface stops; the others go on as if it were not there. With a
    /// texture: the shares at its t = 0 and t = 1.
    std::array<double, 2> opacity{1.0, 1.0};
    int opacity_texture = -1;

    bool is_opaque() const { return opacity[0] >= 1.0 && opacity[1] >= 1.0; }
};

struct Material {
    std::string name;
    Model model = Model::Auto;
    LayerStack stack; ///< air side first; may be empty (bare substrate)
    Substrate substrate;
    SourcePosition position; ///< place of its table, for errors; empty for a material made in code

    bool is_fluorescent() const { return substrate.is_fluorescent() || stack.is_dyed(); }
};

struct Shape {
    std::variant<SphereShape, RectangleShape, DiskShape, MeshShape, CylinderShape, MeshInstance>
        geometry;
    int material = 0; ///< index into Scene::surfaces
};

struct Scene {
    std::filesystem::path file;
    FilmSettings film;
    Camera camera;
    IntegratorSettings integrator;
    std::vector<Light> lights;
    /// Names that lights were given, "" where none: those of one name are a group
    /// (RenderOptions::light_groups). Empty where no light has any.
    std::vector<std::string> light_groups;
    std::vector<Shape> shapes;
    /// Surface i stands for the i-th [[material]] of the file; an untextured one is material i, the
    /// variants of textured ones follow after all of them.
    std::vector<Surface> surfaces;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Image> images;
    std::string hash; ///< hex digest of the scene file and of every file it names
};

/// Surfaces of a scene that was put together in code: surface i is material i.
std::vector<Surface> plain_surfaces(const Scene& scene);

} // namespace reradiant
