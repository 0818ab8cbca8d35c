#include "host/render/tables/scene_tables.h"

#include "host/render/tables/hero_tables.h"
#include "host/render/tables/walk_tables.h"

#include <algorithm>

namespace reradiant {

namespace {

/// Variants of a textured material say the same: once is enough.
void drop_repeats(std::vector<std::string>& notes) {
    std::vector<std::string> once;
    for (std::string& note : notes)
        if (std::find(once.begin(), once.end(), note) == once.end())
            once.push_back(std::move(note));
    notes = std::move(once);
}

} // namespace

SceneTables build_scene_tables(const Scene& scene, const RenderPlan& plan) {
    SceneTables tables;
    tables.notes = plan.notes;
    tables.tables.reserve(plan.counts.tables);
    tables.camera = camera_record(scene.camera, scene.film);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const MaterialPlan& material = plan.materials[i];
        if (material.choice.model == Model::Walk)
            append_walk_material(scene.materials[i], material, plan.wavelengths, tables);
        else
            append_material(scene.materials[i], material, plan.wavelengths, plan.features.lobes,
                            tables);
    }
    drop_repeats(tables.notes);
    append_surfaces(scene, tables);
    append_lights(scene, plan.lights, tables);
    if (plan.wavelengths.hero > 0)
        append_hero(plan.wavelengths, tables);
    return tables;
}

} // namespace reradiant
