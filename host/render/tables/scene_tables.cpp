#include "host/render/tables/scene_tables.h"

#include "host/render/tables/hero_tables.h"
#include "host/render/tables/stack_optics.h"
#include "host/render/tables/walk_tables.h"
#include "host/scene/model/model_choice.h"
#include "kernels/core/features.h"

#include <fmt/core.h>

#include <algorithm>

namespace reradiant {

namespace {

std::string model_note(const Material& material, const ModelChoice& choice) {
    const std::string note =
        fmt::format("material '{}': model {}", material.name, model_name(choice.model));
    return choice.reason.empty() ? note : note + ", " + choice.reason;
}

/// Variants of a textured material say the same: once is enough.
void drop_repeats(std::vector<std::string>& notes) {
    std::vector<std::string> once;
    for (std::string& note : notes)
        if (std::find(once.begin(), once.end(), note) == once.end())
            once.push_back(std::move(note));
    notes = std::move(once);
}

} // namespace

ModelUse use_in(const WavelengthPlan& plan) {
    return plan.hero > 0 ? ModelUse::RenderHero : ModelUse::Render;
}

SceneTables build_scene_tables(const Scene& scene, const WavelengthPlan& plan, Model model,
                               const RenderFeatures& at_least) {
    SceneTables tables;
    tables.features = at_least;
    std::vector<Model> models;
    for (const Material& material : scene.materials) {
        const ModelChoice choice = choose_model(material, model, use_in(plan));
        models.push_back(choice.model);
        tables.notes.push_back(model_note(material, choice));
        if (choice.model != Model::Walk)
            tables.features.lobes =
                std::max(tables.features.lobes, deeper_lobe_count(material, choice.model));
    }
    tables.features.chunks = plan.padded_lanes() / WIDTH;
    tables.features.film_chunks = tables.features.chunks;
    tables.camera = camera_record(scene.camera, scene.film);
    tables.features.lens |= scene.camera.lens_radius > 0.0;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        if (models[i] == Model::Walk)
            append_walk_material(material, plan, tables);
        else
            append_material(material, models[i], plan, tables.features.lobes, tables);
    }
    drop_repeats(tables.notes);
    append_surfaces(scene, tables);
    append_lights(scene, plan, tables);
    if (plan.hero > 0)
        append_hero(scene, plan, tables);
    return tables;
}

} // namespace reradiant
