#include "host/view/view_page.h"

#include "host/report/html.h"
#include "host/report/page_parts.h"
#include "host/view/packed_text.h"
#include "host/view/page_lamps.h"
#include "host/view/page_sources.h"

#include <fmt/format.h>

#include <initializer_list>

namespace reradiant {

using Json = nlohmann::ordered_json;

namespace {

std::string joined(std::initializer_list<const char*> parts) {
    std::string all;
    for (const char* part : parts)
        all += part;
    return all;
}

std::string script() {
    return joined({view_tables_js, view_optics_js, view_models_js, view_weidlich_wilkie_js,
                   view_dyes_js, view_spectra_js, view_scene_js, view_mesh_js, view_gpu_js,
                   view_picture_js, view_toml_js, view_reading_js, view_inputs_js, view_controls_js,
                   view_main_js});
}

Json shaders_json() {
    return {{"access", view_access_glsl}, {"material", view_material_glsl},
            {"adding", view_adding_glsl}, {"weidlich-wilkie", view_weidlich_wilkie_glsl},
            {"render", view_render_glsl}, {"vertex", view_vertex_glsl}};
}

} // namespace

std::string view_page(const ViewPage& page) {
    const Json data = {{"gallery", page.is_gallery},
                       {"lamps", lamps_json(page.lamps)},
                       {"shaders", shaders_json()}};
    Json materials = Json::array();
    for (const ViewedMaterial& material : page.materials)
        materials.push_back(material_data(material, !page.is_gallery));
    constexpr auto on_bad_utf8 = Json::error_handler_t::replace;
    const std::string numbers = packed_text(materials.dump(-1, ' ', false, on_bad_utf8));
    return html_document(
        page.title, joined({page_style, view_css}),
        std::string(view_html) + "<noscript><p>This page needs scripts.</p></noscript>\n" +
            script_data("view-data", data) + "<script type=\"text/plain\" id=\"view-materials\">" +
            numbers + "</script>\n" + "<script type=\"text/plain\" id=\"view-script\">\n" +
            script() + "</script>\n" + "<script>\n" + page_script + view_start_js + "</script>\n");
}

} // namespace reradiant
