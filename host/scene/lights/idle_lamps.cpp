#include "host/scene/lights/idle_lamps.h"

#include "host/scene/meshes/placement.h"
#include "host/scene/model/fluorescence_ranges.h"
#include "host/scene/toml/material_reader.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

namespace reradiant {

namespace {

/// A ball around a shape.
struct Ball {
    Vector3 centre{};
    double radius = 0.0;
};

double length(const Vector3& v) {
    return std::hypot(v[0], v[1], v[2]);
}

double dot(const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3 difference(const Vector3& a, const Vector3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Ball ball_around(const MeshShape& mesh) {
    Vector3 low{}, high{};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const double value = mesh.positions[i];
        low[i % 3] = i < 3 ? value : std::min(low[i % 3], value);
        high[i % 3] = i < 3 ? value : std::max(high[i % 3], value);
    }
    const Vector3 across = difference(high, low);
    return {{low[0] + 0.5 * across[0], low[1] + 0.5 * across[1], low[2] + 0.5 * across[2]},
            0.5 * length(across)};
}

struct BallAround {
    Ball operator()(const SphereShape& s) const { return {s.centre, s.radius}; }
    Ball operator()(const RectangleShape& s) const {
        return {s.centre, 0.5 * (length(s.edge_u) + length(s.edge_v))};
    }
    Ball operator()(const DiskShape& s) const { return {s.centre, s.radius}; }
    Ball operator()(const CylinderShape& s) const {
        const Vector3 along = difference(s.to, s.from);
        return {
            {s.from[0] + 0.5 * along[0], s.from[1] + 0.5 * along[1], s.from[2] + 0.5 * along[2]},
            0.5 * length(along) + s.radius};
    }
    Ball operator()(const MeshShape& s) const { return ball_around(s); }
    Ball operator()(const MeshInstance& s) const {
        const Ball own = ball_around(*s.mesh);
        const Placement placement(s.transform);
        const kernels::Vec3 moved =
            placement.point(kernels::vec3(own.centre[0], own.centre[1], own.centre[2]));
        double stretch = 0.0; // at most the size of the matrix
        for (const kernels::Vec3& row : placement.rows)
            stretch += kernels::vec3_dot(row, row);
        return {{moved.x, moved.y, moved.z}, own.radius * std::sqrt(stretch)};
    }
};

/// Everything that a light may light or be seen by.
std::vector<Ball> what_there_is(const Scene& scene) {
    std::vector<Ball> balls{{scene.camera.origin, scene.camera.lens_radius}};
    for (const Shape& shape : scene.shapes)
        balls.push_back(std::visit(BallAround{}, shape.geometry));
    return balls;
}

/// True where a light sends something into its cone of half angle `cone` about `axis`, beyond the
/// plane or point at `place`, that meets a ball.
bool reaches(const Vector3& place, const Vector3& axis, double cone, const Ball& ball) {
    const Vector3 way = difference(ball.centre, place);
    const double distance = length(way);
    if (distance <= ball.radius)
        return true;
    const double angle =
        std::acos(std::clamp(dot(way, axis) / (distance * length(axis)), -1.0, 1.0));
    return angle - std::asin(ball.radius / distance) < cone;
}

/// Which way a light faces: none for one that shines to all sides.
struct Facing {
    bool any = false;
    Vector3 place{}, axis{};
    double cone = 0.0; ///< below a half turn
    double reach = 0.0;
};

Facing facing_of(const Light& light) {
    constexpr double half_space = 0.5 * std::numbers::pi;
    if (const auto* rectangle = std::get_if<RectangleLight>(&light)) {
        const Vector3 &u = rectangle->edge_u, &v = rectangle->edge_v;
        return {true,
                rectangle->centre,
                {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]},
                half_space};
    }
    if (const auto* disk = std::get_if<DiskLight>(&light))
        return {true, disk->centre, disk->normal, half_space};
    if (const auto* spot = std::get_if<SpotLight>(&light))
        return {spot->cone_deg < 180.0, spot->position, spot->direction,
                spot->cone_deg * std::numbers::pi / 180.0};
    return {};
}

bool is_dark_within(const Spectrum& spectrum, const std::array<double, 2>& range) {
    return range[1] <= 0.0 || spectrum.is_zero_within(range[0], range[1]);
}

std::string dark_reason(const Spectrum& spectrum, const Scene& scene) {
    FluorescenceRanges ranges;
    for (const Material& material : scene.materials)
        ranges.join(fluorescence_ranges(material));
    const std::array<double, 2> film =
        scene.film.bands ? std::array{scene.film.bands->lower_edge_nm(0),
                                      scene.film.bands->upper_edge_nm(scene.film.bands->count - 1)}
                         : default_range_nm(!ranges.is_empty());
    if (!is_dark_within(spectrum, film) || !is_dark_within(spectrum, ranges.excitation))
        return {};
    const std::array<double, 2> own = support_nm(spectrum);
    const std::string excitation = ranges.is_empty()
                                       ? std::string("nothing fluoresces")
                                       : fmt::format("{:.4g} to {:.4g} nm excite what fluoresces",
                                                     ranges.excitation[0], ranges.excitation[1]);
    return fmt::format("its light of {:.4g} to {:.4g} nm lies outside the film's {:.4g} to {:.4g} "
                       "nm, and {}",
                       own[0], own[1], film[0], film[1], excitation);
}

} // namespace

std::string idle_reason(const Light& light, const Scene& scene) {
    const Spectrum& spectrum = light_spectrum(light);
    if (spectrum.is_zero_within(1.0, 1e5))
        return "it is black";
    if (std::string dark = dark_reason(spectrum, scene); !dark.empty())
        return dark;
    const Facing facing = facing_of(light);
    if (!facing.any || scene.shapes.empty())
        return {};
    for (const Ball& ball : what_there_is(scene))
        if (reaches(facing.place, facing.axis, facing.cone, ball))
            return {};
    return "it faces away from every shape, and from the camera";
}

} // namespace reradiant
