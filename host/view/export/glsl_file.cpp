#include "host/view/export/exchange_files.h"

#include "host/view/export/glsl_tables.h"
#include "host/view/page_sources.h"
#include "reradiant/colour.h"

#include <fmt/format.h>

#include <algorithm>

namespace reradiant {

namespace {

/// Four bands are a vector; what is beyond the last is dark.
std::string vectors(const std::vector<double>& by_band) {
    std::string text;
    for (std::size_t first = 0; first < by_band.size(); first += 4) {
        text += text.empty() ? "" : ",\n    ";
        for (std::size_t lane = 0; lane < 4; ++lane)
            text += fmt::format("{}{:.7g}", lane == 0 ? "vec4(" : ", ",
                                first + lane < by_band.size() ? by_band[first + lane] : 0.0);
        text += ")";
    }
    return text;
}

std::string array_of(const char* name, const std::vector<std::vector<double>>& lists) {
    std::string text;
    std::size_t count = 0;
    for (const std::vector<double>& list : lists) {
        text += (text.empty() ? "    " : ",\n    ") + vectors(list);
        count += (list.size() + 3) / 4;
    }
    return fmt::format("const vec4 {}[{}] = vec4[](\n{});\n", name, count, text);
}

/// Lists by table, chunk and node, whose bands are a vector each.
std::vector<std::vector<double>> node_lists(const GlslTables& tables) {
    std::vector<std::vector<double>> lists;
    for (const auto& table : tables.tables)
        for (std::size_t first = 0; first < table.size(); first += 4)
            for (std::size_t node = 0; node < glsl_nodes; ++node) {
                std::vector<double>& four = lists.emplace_back();
                for (std::size_t band = first; band < first + 4; ++band)
                    four.push_back(band < table.size() ? table[band][node] : 0.0);
            }
    return lists;
}

/// Appends the lamp, Y = 1, and what the bands weigh in linear sRGB.
void add_lamp(GlslTables& tables, const Lamp& lamp) {
    const std::vector<Xyz> weights = xyz_weights(tables.bands);
    std::vector<double> light;
    double y = 0.0, energy = 0.0;
    for (int band = 0; band < tables.bands.count; ++band) {
        light.push_back(
            lamp.light.average(tables.bands.lower_edge_nm(band), tables.bands.upper_edge_nm(band)));
        y += light.back() * weights[static_cast<std::size_t>(band)][1];
        energy += light.back() * tables.bands.step_nm / 480.0;
    }
    const double level = std::max({y, 0.5 * energy, 1e-30});
    for (double& value : light)
        value /= level;
    tables.defines.emplace_back("RR_LAMP_ROW", static_cast<int>(tables.rows.size()));
    tables.rows.push_back(light);
    tables.defines.emplace_back("RR_WEIGHT_ROW", static_cast<int>(tables.rows.size()));
    for (std::size_t channel = 0; channel < 3; ++channel) {
        std::vector<double>& row = tables.rows.emplace_back();
        for (const Xyz& weight : weights)
            row.push_back(xyz_to_linear_srgb(weight)[channel]);
    }
}

constexpr const char* evaluation = R"glsl(
vec3 rr_seen(vec4 radiance, int chunk) {
    return vec3(dot(radiance, RR_BAND(RR_WEIGHT_ROW, chunk)), dot(radiance, RR_BAND(RR_WEIGHT_ROW + 1, chunk)),
                dot(radiance, RR_BAND(RR_WEIGHT_ROW + 2, chunk)));
}

// Linear sRGB of the radiance towards wo of the lamp's light along -wi, whose irradiance on a surface that
// faces it has Y = 1; the cosine of wi is in it, the mirror's delta of smooth interfaces is not. Unit
// vectors, z the normal.
vec3 rr_eval(vec3 wi, vec3 wo) {
    vec3 sum = vec3(0.0);
    RrSums first, rest;
    if (wi.z <= 0.0 || wo.z <= 0.0) return sum;
    for (int k = 0; k <= RR_TERMS; ++k) first.terms[k] = rest.terms[k] = 0.0;
    rr_here = rr_geometry(wi, wo, 0.0);
    for (int chunk = 0; chunk < RR_CHUNKS; ++chunk)
        sum += rr_seen(rr_chunk(chunk, RR_BAND(RR_LAMP_ROW, chunk), first, rest), chunk);
    return sum;
}

// Linear sRGB of the mirror's weight under the lamp: what a smooth interface reflects of it.
vec3 rr_mirror_colour(float cosine) {
    vec3 sum = vec3(0.0);
    for (int chunk = 0; chunk < RR_CHUNKS; ++chunk)
        sum += rr_seen(RR_BAND(RR_LAMP_ROW, chunk) * rr_mirror(chunk, cosine), chunk);
    return sum;
}
)glsl";

} // namespace

std::string glsl_file(const ViewedMaterial& viewed, const Lamp& lamp) {
    require_exchangeable(viewed.material);
    GlslTables tables = glsl_tables(viewed.material);
    add_lamp(tables, lamp);
    LampColours said;
    said.material = viewed.name;
    said.lamp = lamp.name;
    said.left_out = tables.left_out;
    said.left_out.push_back("Any other lamp: this one is in the constants.");
    if (viewed.material.stack.is_dispersive() && tables.model == Model::WeidlichWilkie)
        said.left_out.push_back("Directions refract by the first band's indices alone.");
    std::string text = exchange_head(
        said, fmt::format("model {}, GLSL ES 3.00 functions", model_name(tables.model)), "//");
    for (const auto& [name, value] : tables.defines)
        text += fmt::format("#define {} {}\n", name, value);
    text +=
        array_of("rr_band_values", tables.rows) + array_of("rr_node_values", node_lists(tables));
    text += "#define RR_BAND(row, chunk) rr_band_values[(row) * RR_CHUNKS + (chunk)]\n"
            "#define RR_NODE(table, chunk, node) "
            "rr_node_values[((table) * RR_CHUNKS + (chunk)) * RR_NODES + (node)]\n";
    for (const std::string& constant : tables.constants)
        text += constant + "\n";
    return text + view_material_glsl +
           (tables.model == Model::Adding ? view_adding_glsl : view_weidlich_wilkie_glsl) +
           evaluation;
}

} // namespace reradiant
