#include "host/check/checked_function.h"

#include <cmath>

namespace reradiant {

namespace {

std::array<LayerRecord, CHECK_LAYERS> layers() {
    constexpr std::uint32_t beckmann = 1, ggx = 2;
    const LayerRecord coat{1.5f, 0.2f, ggx, NO_INDEX, 0.0f, NO_INDEX};
    const LayerRecord smooth{1.2f, 0.0f, ggx, NO_INDEX, 0.0f, NO_INDEX};
    const LayerRecord flakes{1.0f, 0.3f, beckmann, NO_INDEX, 0.25f, NO_INDEX};
    return {coat, smooth, flakes};
}

MaterialRecord material() {
    MaterialRecord record{};
    record.layer_count = CHECK_LAYERS - 1;
    record.lobe_count = LOBES;
    record.has_top_lobe = 1;
    record.weidlich_wilkie = MODEL_A;
    record.sigma = 0.3f;
    record.lowest_ior = 1.5f;
    record.spread_value = NO_INDEX;
    record.other_side = NO_INDEX;
    return record;
}

void fill_textures(CheckTables& tables) {
    TextureRecord texture{};
    texture.space = TEXTURE_WORLD;
    texture.inverse_size = 1.0f;
    texture.octaves = 3;
    texture.tilt = 0.2f;
    texture.sharpness = 1.0f;
    texture.width = CHECK_IMAGE_WIDTH;
    texture.height = CHECK_IMAGE_HEIGHT;
    texture.levels = 4;
    texture.seed = 11;
    constexpr std::uint32_t types[] = {TEXTURE_NOISE, TEXTURE_VORONOI, TEXTURE_CHECKER,
                                       TEXTURE_IMAGE};
    for (std::size_t i = 0; i < CHECK_TEXTURES; ++i) {
        tables.textures[i] = texture;
        tables.textures[i].type = types[i];
    }
    tables.textures[3].space = TEXTURE_UV;
}

void fill_lights(CheckTables& tables) {
    LightRecord rectangle{};
    rectangle.type = LIGHT_RECTANGLE;
    rectangle.py = 2.0f;
    rectangle.ux = 2.0f;
    rectangle.vz = 3.0f;
    rectangle.ny = -1.0f;
    rectangle.radius_or_area = 6.0f;
    LightRecord sphere = rectangle;
    sphere.type = LIGHT_SPHERE;
    sphere.radius_or_area = 0.4f;
    LightRecord point = rectangle;
    point.type = LIGHT_POINT;
    LightRecord directional = rectangle;
    directional.type = LIGHT_DIRECTIONAL;
    const LightRecord lights[] = {rectangle, sphere, point, directional};
    std::copy(std::begin(lights), std::end(lights), tables.lights);
    for (int i = 0; i < CHECK_LIGHTS; ++i)
        tables.lights[i].cumulative = 0.25f * static_cast<float>(i + 1);
}

/// What lights_sample does not know: lamps of other shapes, and those with a cone.
void fill_lamps(CheckTables& tables) {
    LightRecord disk{};
    disk.type = LIGHT_DISK;
    disk.py = 2.0f;
    disk.ux = disk.vz = 0.8f;
    disk.ny = -1.0f;
    disk.radius_or_area = 2.0f;
    LightRecord mesh{};
    mesh.type = LIGHT_MESH;
    mesh.radius_or_area = 2.0f;
    mesh.triangle_count = 2;
    LightRecord spot = disk;
    spot.type = LIGHT_SPOT;
    spot.cone = 0.4f;
    spot.full_cone = 0.1f;
    LightRecord distant = spot;
    distant.type = LIGHT_DISTANT;
    distant.cone = 1e-5f;
    const LightRecord lamps[] = {disk, mesh, spot, distant};
    std::copy(std::begin(lamps), std::end(lamps), tables.lamps);
    constexpr float triangles[] = {0.3f,  1.0f,                                            // shares
                                   -1.0f, 2.0f, 0.0f, 0.2f, 2.0f, 0.0f, -1.0f, 2.5f, 1.0f, //
                                   0.2f,  2.0f, 0.0f, 0.4f, 2.2f, 1.9f, -1.0f, 2.5f, 1.0f};
    std::copy(std::begin(triangles), std::end(triangles), tables.triangles);
}

void fill_camera(CameraRecord& camera) {
    camera = {};
    camera.origin_y = 2.0f;
    camera.origin_z = 6.0f;
    camera.lens_radius = 0.1f;
    camera.focus_distance = 6.0f;
    camera.right_x = 0.56f;
    camera.up_y = 0.31f;
    camera.up_z = -0.05f;
    camera.forward_y = -0.16f;
    camera.forward_z = -0.98f;
    camera.width = 640;
    camera.height = 360;
}

/// Cumulative sums of n positive numbers over their total; what lies below the first one is first.
void fill_cumulative(float* out, const float* values, int n) {
    double total = 0.0, sum = 0.0;
    for (int i = 0; i < n; ++i)
        total += static_cast<double>(values[i]);
    for (int i = 0; i < n; ++i) {
        out[i] = static_cast<float>(sum / total);
        sum += static_cast<double>(values[i]);
    }
}

/// An image, densities and cumulative sums one after the other, as EnvironmentRecord has them.
void fill_environment(CheckTables& tables) {
    constexpr int w = CHECK_IMAGE_WIDTH, h = CHECK_IMAGE_HEIGHT, texels = w * h;
    tables.environment = {0, 0, 3 * texels, 4 * texels, 5 * texels, w, h, 0.125f};
    float* const density = tables.image + 3 * texels;
    float rows[h] = {};
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            for (int c = 0; c < 3; ++c)
                tables.image[3 * (y * w + x) + c] =
                    0.5f + 0.25f * static_cast<float>(std::sin(0.7 * x + 1.3 * y + c));
            density[y * w + x] = 1.0f + 0.5f * static_cast<float>(std::cos(0.9 * x - 0.4 * y));
            rows[y] += density[y * w + x];
        }
        fill_cumulative(tables.image + 4 * texels + y * w, density + y * w, w);
    }
    fill_cumulative(tables.image + 5 * texels, rows, h);
}

/// Cumulative probabilities that change with the angle, and an albedo.
void fill_choice(CheckTables& tables) {
    for (int node = 0; node < TABLE_NODES; ++node)
        for (int i = 0; i < CHECK_CHOICES; ++i)
            tables.choice[node * CHECK_CHOICES + i] =
                i == CHECK_CHOICES - 2
                    ? 1.0f
                    : 0.11f * static_cast<float>(i + 1) + 0.001f * static_cast<float>(node);
}

/// Ratios that change along all three axes, the same for both orders of the directions.
void fill_shape(CheckTables& tables) {
    constexpr std::size_t cosines = SHAPE_COSINES, slopes = SHAPE_PLACES;
    for (std::size_t i = 0; i < cosines; ++i)
        for (std::size_t o = 0; o < cosines; ++o)
            for (std::size_t s = 0; s < slopes; ++s)
                tables.shape[(i * cosines + o) * slopes + s] =
                    0.02f + 0.002f * static_cast<float>(i * o) + 0.001f * static_cast<float>(s * s);
}

void fill_ratio(CheckTables& tables) {
    for (std::size_t i = 0; i < LOBE_RATIO_SIZE; ++i)
        tables.ratio[i] = 1.0f + 0.3f * static_cast<float>(std::sin(0.01 * static_cast<double>(i)));
}

void fill_lanes(CheckTables& tables) {
    for (int i = 0; i < 2 * CHECK_RANK * LANES; ++i)
        tables.factors[i] = 0.02f + 0.01f * static_cast<float>(std::sin(0.37 * i));
    for (int i = 0; i < LANES * LANES; ++i)
        tables.dense[i] = 0.02f + 0.01f * static_cast<float>(std::cos(0.11 * i));
    for (int row = 0; row < LANES; ++row)
        for (int lane = 0; lane < LANES; ++lane)
            tables.shift[row * LANES + lane] = static_cast<float>(
                std::pow((lane + 1.0) / LANES, 0.5 + 0.05 * static_cast<double>(row)));
}

} // namespace

CheckTables check_tables() {
    CheckTables tables{};
    tables.material = material();
    const auto stack = layers();
    std::copy(stack.begin(), stack.end(), tables.layers);
    tables.lobes[0] = {0.3f, 1, CHECK_LAYERS - 1, NO_INDEX, NO_INDEX, NO_INDEX, 0.0f};
    // a slab of anisotropy 0.6 beneath the coat
    tables.lobes[1] = {0.6f, 0, 1, 0, NO_INDEX, NO_INDEX, 0.0f};
    fill_textures(tables);
    fill_lamps(tables);
    fill_lights(tables);
    fill_camera(tables.camera);
    fill_environment(tables);
    fill_choice(tables);
    fill_shape(tables);
    fill_ratio(tables);
    fill_lanes(tables);
    return tables;
}

Argument unit() {
    return {Argument::Kind::Uniform, 0.0, 1.0, {0.0f, 0x1p-24f, 0.5f, 1.0f - 0x1p-24f}};
}
Argument cosine() {
    return {Argument::Kind::Cosine,
            0.0,
            1.0,
            {0.0f, 1e-30f, 1e-8f, 1e-4f, 0.5f, 0.745356f, 0.9999999f, 1.0f}};
}
Argument ior() {
    return {Argument::Kind::NearOne,
            0.25,
            4.0,
            {0.25f, 2.0f / 3.0f, 0.9999f, 0.999999f, 1.0f, 1.000001f, 1.0001f, 1.5f, 4.0f}};
}
Argument alpha() {
    return {Argument::Kind::Logarithmic, 1e-4, 1.0, {1e-4f, 1e-3f, 0.02f, 0.3f, 0.99f, 1.0f}};
}
Argument direction() {
    // towards the normal, 45 degrees, 89 and 89.999 degrees, grazing
    return {Argument::Kind::Direction,
            0.0,
            1.0,
            {0.0f, 0.0f, 1.0f, 0.70710677f, 0.0f, 0.70710677f, 0.0f, 0.99984770f, 0.017452406f,
             -1.0f, 0.0f, 1.7453293e-5f, 0.6f, 0.8f, 1e-8f}};
}
Argument any_direction() {
    Argument argument{Argument::Kind::Sphere, 0.0, 1.0, direction().hard};
    argument.hard.insert(argument.hard.end(), {0.0f, 0.0f, -1.0f, 0.6f, 0.0f, -0.8f});
    return argument;
}
Argument between(double from, double to) {
    const auto a = static_cast<float>(from), b = static_cast<float>(to);
    return {Argument::Kind::Uniform, from, to, {a, 0.5f * (a + b), b}};
}
Argument integer(int count) {
    return {Argument::Kind::Integer,
            0.0,
            static_cast<double>(count),
            {0.0f, static_cast<float>(count - 1)}};
}

std::vector<CheckedFunction> checked_functions() {
    std::vector<CheckedFunction> all;
    for (const auto& some : {interface_functions(), stack_functions(), walk_functions(),
                             light_functions(), texture_functions(), lane_functions()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

} // namespace reradiant
