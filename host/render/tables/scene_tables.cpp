#include "host/render/tables/scene_tables.h"

#include "host/render/tables/hero_tables.h"
#include "host/render/tables/walk_tables.h"

#include <algorithm>
#include <deque>
#include <map>

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

/// Appends all materials in their order; the other sides of sheets follow after them.
void append_materials(const Scene& scene, const RenderPlan& plan, SceneTables& tables) {
    std::map<std::size_t, MaterialOptics> sheets;
    std::deque<MaterialOptics> recent;
    std::vector<std::size_t> walked_sheets;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        const MaterialPlan& planned = plan.materials[i];
        if (planned.choice.model == Model::Walk) {
            append_walk_material(material, planned, plan.wavelengths, tables);
            if (material.stack.is_sheet())
                walked_sheets.push_back(i);
            continue;
        }
        MaterialOptics optics(material, planned.choice.model, plan.wavelengths, recent);
        append_material(material, planned, plan.wavelengths, plan.features, optics, tables);
        if (optics.is_sheet())
            sheets.emplace(i, std::move(optics));
    }
    for (const auto& [index, optics] : sheets)
        append_other_side(scene.materials[index], plan.materials[index], plan.wavelengths,
                          plan.features, optics, index, tables);
    for (const std::size_t index : walked_sheets)
        append_walked_other_side(scene.materials[index], plan.materials[index], plan.wavelengths,
                                 index, tables);
    for (const std::uint32_t material : plan.passed_sheets)
        if (material != NO_INDEX) {
            MaterialRecord& above = tables.materials[material];
            above.is_passed = tables.materials[above.other_side].is_passed = 1u;
        }
}

} // namespace

SceneTables build_scene_tables(const Scene& scene, const RenderPlan& plan) {
    SceneTables tables;
    tables.notes = plan.notes;
    tables.tables.reserve(plan.counts.tables);
    tables.camera = camera_record(scene.camera, scene.film);
    append_materials(scene, plan, tables);
    drop_repeats(tables.notes);
    append_surfaces(scene, tables);
    append_lights(scene, plan.lights, tables);
    if (plan.wavelengths.hero > 0)
        append_hero(plan.wavelengths, tables);
    return tables;
}

} // namespace reradiant
