#include "host/scene/toml/scene_parts.h"

#include "host/scene/images/image_io.h"
#include "host/scene/meshes/mesh_io.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr std::size_t MAX_VERTICES = std::size_t{1} << 24; ///< 4096 x 4096: 0.9 GB of mesh

/// A grid of heights over a parallelogram; pixel (0, 0) lies at v = 1, as in textures.
struct Heights {
    int width = 0, height = 0;
    std::vector<double> values; ///< lengths along the parallelogram's normal
    Vector3 corner{}, edge_u{}, edge_v{}, normal{};

    double at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    double u(int x) const { return static_cast<double>(x) / (width - 1); }
    double v(int y) const { return 1.0 - static_cast<double>(y) / (height - 1); }
};

Vector3 sum(const Vector3& a, double factor, const Vector3& b) {
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

/// Luminance of linear sRGB (IEC 61966-2-1) times `scale`.
std::vector<double> heights_of(const Image& image, double scale) {
    std::vector<double> values(image.rgb.size() / 3);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] =
            scale * (0.2126 * double{image.rgb[3 * i]} + 0.7152 * double{image.rgb[3 * i + 1]} +
                     0.0722 * double{image.rgb[3 * i + 2]});
    return values;
}

/// Normal of the surface from central differences, one-sided at the edges.
Vector3 surface_normal(const Heights& grid, int x, int y) {
    const int left = std::max(x - 1, 0), right = std::min(x + 1, grid.width - 1);
    const int above = std::max(y - 1, 0), below = std::min(y + 1, grid.height - 1);
    const double slope_u = (grid.at(right, y) - grid.at(left, y)) / (grid.u(right) - grid.u(left));
    const double slope_v =
        (grid.at(x, above) - grid.at(x, below)) / (grid.v(above) - grid.v(below));
    const Vector3 n = vector_cross(sum(grid.edge_u, slope_u, grid.normal),
                                   sum(grid.edge_v, slope_v, grid.normal));
    const double length = vector_length(n);
    return {n[0] / length, n[1] / length, n[2] / length};
}

void append_vertices(const Heights& grid, const SourcePosition& at, MeshShape& mesh) {
    const std::string name = "a vertex of the heightfield";
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) {
            const Vector3 flat =
                sum(sum(grid.corner, grid.u(x), grid.edge_u), grid.v(y), grid.edge_v);
            const Vector3 p = sum(flat, grid.at(x, y), grid.normal);
            const Vector3 n = surface_normal(grid, x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                mesh.positions.push_back(mesh_coordinate(p[c], at, name));
                mesh.normals.push_back(static_cast<float>(n[c]));
            }
            mesh.texture_coordinates.push_back(static_cast<float>(grid.u(x)));
            mesh.texture_coordinates.push_back(static_cast<float>(grid.v(y)));
        }
}

void append_triangles(const Heights& grid, MeshShape& mesh) {
    const auto vertex = [&](int x, int y) {
        return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(grid.width) +
               static_cast<std::uint32_t>(x);
    };
    for (int y = 0; y + 1 < grid.height; ++y)
        for (int x = 0; x + 1 < grid.width; ++x) // anticlockwise as the normal sees them
            append_fan({vertex(x, y), vertex(x, y + 1), vertex(x + 1, y + 1), vertex(x + 1, y)},
                       mesh);
}

} // namespace

MeshShape read_heightfield(const TableReader& reader, LoadState& state) {
    Heights grid;
    const auto edges = read_edges(reader);
    grid.edge_u = edges[0];
    grid.edge_v = edges[1];
    grid.corner = sum(sum(reader.vector("center"), -0.5, edges[0]), -0.5, edges[1]);
    const Vector3 across = vector_cross(edges[0], edges[1]);
    grid.normal = sum({}, 1.0 / vector_length(across), across);
    const double scale =
        reader.number_or("height", 1.0, NumberRange::within(-MAX_COORDINATE, MAX_COORDINATE));
    const SourcePosition at = reader.position_of_key("file");
    const auto index =
        static_cast<std::size_t>(load_image(reader.text("file"), at, ImageEncoding::Linear, state));
    const Image& image = state.images[index];
    if (image.width < 2 || image.height < 2 || image.rgb.size() / 3 > MAX_VERTICES)
        throw_input_error(at,
                          fmt::format("the heights are {} x {} pixels", image.width, image.height),
                          fmt::format("give at least 2 x 2 and at most {}", MAX_VERTICES));
    grid.width = image.width;
    grid.height = image.height;
    grid.values = heights_of(image, scale);
    MeshShape mesh;
    mesh.file = image.file;
    append_vertices(grid, at, mesh);
    append_triangles(grid, mesh);
    return mesh;
}

} // namespace reradiant
