#include "host/render/scene_tables.h"

#include "host/render/stack_optics.h"
#include "host/render/walk_tables.h"
#include "kernels/features.h"

#include <fmt/format.h>

namespace reradiant {

namespace {

/// The model that renders a material: `auto` takes adding, which is exact for diffuse substrates;
/// the walk is slow and has to be asked for.
Model chosen_model(const Material& material, Model requested) {
    const Model model = requested == Model::Auto ? material.model : requested;
    return model == Model::Auto ? Model::Adding : model;
}

} // namespace

SceneTables build_scene_tables(const Scene& scene, const WavelengthPlan& plan, Model model,
                               bool keep_all) {
    SceneTables tables;
    if (keep_all)
        tables.features = RenderFeatures::all();
    for (const Material& material : scene.materials)
        if (const Model chosen = chosen_model(material, model); chosen != Model::Walk)
            tables.features.lobes =
                std::max(tables.features.lobes, deeper_lobe_count(material, chosen));
    tables.features.chunks = plan.padded_lanes() / WIDTH;
    tables.features.film_chunks = tables.features.chunks;
    tables.camera = camera_record(scene.camera, scene.film);
    tables.features.lens |= scene.camera.lens_radius > 0.0;
    for (const Material& material : scene.materials) {
        const Model chosen = chosen_model(material, model);
        tables.notes.push_back(
            fmt::format("material '{}': model {}", material.name, model_name(chosen)));
        if (chosen == Model::Walk)
            append_walk_material(material, plan, scene.file.string(), tables);
        else
            append_material(material, chosen, plan, tables.features.lobes, tables);
    }
    append_surfaces(scene, tables);
    append_lights(scene, plan, tables);
    return tables;
}

} // namespace reradiant
