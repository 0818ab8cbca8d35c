#pragma once

namespace reradiant {

/// Sources of the page and of shader files, which host/view/page holds as files of their own.
extern const char* const view_html;
extern const char* const view_css;
extern const char* const view_start_js;
extern const char* const view_tables_js;
extern const char* const view_optics_js;
extern const char* const view_models_js;
extern const char* const view_weidlich_wilkie_js;
extern const char* const view_dyes_js;
extern const char* const view_spectra_js;
extern const char* const view_scene_js;
extern const char* const view_mesh_js;
extern const char* const view_gpu_js;
extern const char* const view_picture_js;
extern const char* const view_toml_js;
extern const char* const view_reading_js;
extern const char* const view_inputs_js;
extern const char* const view_controls_js;
extern const char* const view_main_js;
extern const char* const view_access_glsl;
extern const char* const view_material_glsl;
extern const char* const view_adding_glsl;
extern const char* const view_weidlich_wilkie_glsl;
extern const char* const view_render_glsl;
extern const char* const view_vertex_glsl;
/// Those of host/view/lights.
extern const char* const lights_html;
extern const char* const lights_css;
extern const char* const lights_layers_js;
extern const char* const lights_js;

} // namespace reradiant
