#include "host/render/tables/environment_tables.h"
#include "host/render/tables/scene_tables.h"
#include "host/scene/meshes/mesh_io.h"
#include "kernels/core/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace reradiant {

namespace {

float narrow(double value) {
    return static_cast<float>(value);
}

Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Vector3& v) {
    return std::hypot(v[0], v[1], v[2]);
}

void set_position(LightRecord& record, const Vector3& position) {
    record.px = narrow(position[0]);
    record.py = narrow(position[1]);
    record.pz = narrow(position[2]);
}

void set_normal(LightRecord& record, const Vector3& direction) {
    const double size = length(direction);
    record.nx = narrow(direction[0] / size);
    record.ny = narrow(direction[1] / size);
    record.nz = narrow(direction[2] / size);
}

/// Without cancellation in thin cones.
double one_minus_cosine(double angle_deg) {
    const double sine = std::sin(0.5 * angle_deg * std::numbers::pi / 180.0);
    return 2.0 * sine * sine;
}

/// Appends what a light's points are sampled from (LightRecord::triangles) and says so in its
/// record. Triangles without an area have no share.
void append_mesh_light(const MeshShape& mesh, LightRecord& record, std::vector<float>& tables) {
    const std::vector<double> areas = triangle_areas(mesh);
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    record.radius_or_area = static_cast<float>(area);
    record.triangles = static_cast<std::uint32_t>(tables.size());
    record.triangle_count = static_cast<std::uint32_t>(areas.size());
    double sum = 0.0;
    for (const double part : areas) {
        sum += part;
        tables.push_back(static_cast<float>(sum / area));
    }
    for (const std::uint32_t vertex : mesh.indices)
        for (std::size_t axis = 0; axis < 3; ++axis)
            tables.push_back(mesh.positions[3 * std::size_t{vertex} + axis]);
}

/// Geometry of a light; returns the factor from its mean spectral value to its power (relative,
/// for the choice among lights only).
struct DescribeLight {
    LightRecord& record;
    std::vector<float>& tables;

    double operator()(const RectangleLight& light) const {
        record.type = LIGHT_RECTANGLE;
        set_position(record, light.centre);
        record.ux = narrow(light.edge_u[0]);
        record.uy = narrow(light.edge_u[1]);
        record.uz = narrow(light.edge_u[2]);
        record.vx = narrow(light.edge_v[0]);
        record.vy = narrow(light.edge_v[1]);
        record.vz = narrow(light.edge_v[2]);
        const Vector3 normal = cross(light.edge_u, light.edge_v);
        set_normal(record, normal);
        record.radius_or_area = narrow(length(normal));
        return std::numbers::pi * length(normal);
    }
    double operator()(const SphereLight& light) const {
        record.type = LIGHT_SPHERE;
        set_position(record, light.centre);
        record.radius_or_area = narrow(light.radius);
        return 4.0 * std::numbers::pi * std::numbers::pi * light.radius * light.radius;
    }
    double operator()(const DiskLight& light) const {
        record.type = LIGHT_DISK;
        set_position(record, light.centre);
        set_normal(record, light.normal);
        const double size = length(light.normal);
        const kernels::Frame frame = kernels::sampling_frame(
            kernels::vec3(light.normal[0] / size, light.normal[1] / size, light.normal[2] / size));
        record.ux = narrow(frame.tangent.x * light.radius);
        record.uy = narrow(frame.tangent.y * light.radius);
        record.uz = narrow(frame.tangent.z * light.radius);
        record.vx = narrow(frame.bitangent.x * light.radius);
        record.vy = narrow(frame.bitangent.y * light.radius);
        record.vz = narrow(frame.bitangent.z * light.radius);
        const double area = std::numbers::pi * light.radius * light.radius;
        record.radius_or_area = narrow(area);
        return std::numbers::pi * area;
    }
    double operator()(const MeshLight& light) const {
        record.type = LIGHT_MESH;
        append_mesh_light(light.mesh, record, tables);
        return std::numbers::pi * mesh_area(light.mesh);
    }
    double operator()(const SpotLight& light) const {
        record.type = LIGHT_SPOT;
        set_position(record, light.position);
        set_normal(record, light.direction);
        record.cone = narrow(one_minus_cosine(light.cone_deg));
        record.full_cone = narrow(one_minus_cosine(light.cone_deg - light.falloff_deg));
        // half of the falloff counts, as in pbrt-v4
        return std::numbers::pi * (one_minus_cosine(light.cone_deg) +
                                   one_minus_cosine(light.cone_deg - light.falloff_deg));
    }
    double operator()(const PointLight& light) const {
        record.type = LIGHT_POINT;
        set_position(record, light.position);
        return 4.0 * std::numbers::pi;
    }
    double operator()(const DirectionalLight& light) const {
        record.type = light.angle_deg > 0.0 ? LIGHT_DISTANT : LIGHT_DIRECTIONAL;
        set_normal(record, light.direction);
        record.cone = narrow(one_minus_cosine(0.5 * light.angle_deg));
        return std::numbers::pi;
    }
    /// A constant environment is found by the paths' own directions, an image is sampled too.
    double operator()(const EnvironmentLight& light) const {
        record.type = LIGHT_ENVIRONMENT;
        return light.image >= 0 ? 4.0 * std::numbers::pi * std::numbers::pi : 0.0;
    }
};

/// Half by power, half evenly: a dim light close by must not be missed.
void set_selection(std::vector<LightRecord>& lights, const std::vector<double>& powers) {
    double total = 0.0;
    int sampled = 0;
    for (const double power : powers) {
        total += power;
        sampled += power > 0.0 ? 1 : 0;
    }
    double cumulative = 0.0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double selection = powers[i] > 0.0 ? 0.5 * powers[i] / total + 0.5 / sampled : 0.0;
        cumulative += selection;
        lights[i].selection = narrow(selection);
        lights[i].cumulative = narrow(cumulative);
    }
}

/// The lights with what each layer has of their spectra.
void append_layers(const LightPlan& plan, SceneTables& tables) {
    if (plan.layers.empty())
        return;
    const auto dark = static_cast<std::uint32_t>(tables.tables.size());
    tables.tables.resize(tables.tables.size() + plan.dark_floats(), 0.0f);
    for (const LightLayerPlan& layer : plan.layers) {
        std::vector<LightRecord> lights = tables.lights;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const std::vector<float>& lanes = layer.spectra[i];
            lights[i].spectrum =
                lanes.empty() ? dark : static_cast<std::uint32_t>(tables.tables.size());
            tables.tables.insert(tables.tables.end(), lanes.begin(), lanes.end());
        }
        tables.layer_lights.push_back(std::move(lights));
    }
}

} // namespace

void append_lights(const Scene& scene, const LightPlan& plan, SceneTables& tables) {
    std::vector<double> powers;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const LightSpectrum& spectrum = plan.lights[i];
        LightRecord record{};
        powers.push_back(std::visit(DescribeLight{record, tables.tables}, scene.lights[i]) *
                         spectrum.mean);
        record.spectrum = static_cast<std::uint32_t>(tables.tables.size());
        tables.tables.insert(tables.tables.end(), spectrum.lanes.begin(), spectrum.lanes.end());
        const auto* sky = std::get_if<EnvironmentLight>(&scene.lights[i]);
        if (sky != nullptr && sky->image >= 0 && !spectrum.lanes.empty()) {
            tables.image =
                append_environment_image(scene.images[static_cast<std::size_t>(sky->image)],
                                         sky->rotation_deg, tables.tables);
            tables.image.light = static_cast<std::uint32_t>(i);
        }
        tables.lights.push_back(record);
    }
    set_selection(tables.lights, powers);
    for (std::size_t i = 0; i < powers.size(); ++i)
        if (powers[i] > 0.0)
            tables.sampled_lights = static_cast<std::uint32_t>(i + 1);
    tables.environment = plan.environment;
    append_layers(plan, tables);
}

CameraRecord camera_record(const Camera& camera, const FilmSettings& film) {
    Vector3 forward{}, right{}, up{};
    for (std::size_t i = 0; i < 3; ++i)
        forward[i] = camera.target[i] - camera.origin[i];
    right = cross(forward, camera.up);
    up = cross(right, forward);
    const double half_height = std::tan(0.5 * camera.fov_deg * std::numbers::pi / 180.0);
    const double half_width = half_height * film.width / film.height;
    CameraRecord record{};
    const auto store = [](const Vector3& v, double size, float& x, float& y, float& z) {
        const double scale = size / length(v);
        x = narrow(v[0] * scale);
        y = narrow(v[1] * scale);
        z = narrow(v[2] * scale);
    };
    record.origin_x = narrow(camera.origin[0]);
    record.origin_y = narrow(camera.origin[1]);
    record.origin_z = narrow(camera.origin[2]);
    store(forward, 1.0, record.forward_x, record.forward_y, record.forward_z);
    store(right, half_width, record.right_x, record.right_y, record.right_z);
    store(up, half_height, record.up_x, record.up_y, record.up_z);
    record.lens_radius = narrow(camera.lens_radius);
    record.focus_distance = narrow(camera.focus_distance);
    record.width = static_cast<std::uint32_t>(film.width);
    record.height = static_cast<std::uint32_t>(film.height);
    return record;
}

} // namespace reradiant
