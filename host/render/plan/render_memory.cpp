#include "host/render/plan/render_memory.h"

#include "host/base/memory_limit.h"
#include "host/render/film/film_sums.h"
#include "host/render/tables/hero_tables.h"
#include "host/render/tables/scene_tables.h"
#include "host/render/tables/stack_optics.h"
#include "host/render/wavefront/wavefront.h"
#include "host/scene/model/model_choice.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>

namespace reradiant {

namespace {

/// `ModelBytes` holds the bytes that models need for each vertex of a path, and for each path that
/// walks.
struct ModelBytes {
    std::uint64_t vertex = 0, path = 0;
};
ModelBytes model_bytes(const Scene& scene, const WavelengthPlan& plan, Model requested) {
    int most_lobes = 0;
    bool walks = false;
    for (const Material& material : scene.materials) {
        const Model model = choose_model(material, requested, use_in(plan)).model;
        walks |= model == Model::Walk;
        if (model != Model::Walk)
            most_lobes = std::max(most_lobes, deeper_lobe_count(material, model));
    }
    ModelBytes bytes{2 * sizeof(float) * static_cast<std::uint64_t>(most_lobes), 0};
    if (walks) {
        bytes.vertex += sizeof(WalkVertexRecord);
        bytes.path += walk_chunks_a_path * sizeof(WalkChunk);
    }
    return bytes;
}

/// Returns true when images colour lights or reflectances, so that vertices keep colours.
bool has_colours(const Scene& scene) {
    const auto is_image = [](const Light& light) {
        const auto* sky = std::get_if<EnvironmentLight>(&light);
        return sky != nullptr && sky->image >= 0;
    };
    return std::any_of(scene.lights.begin(), scene.lights.end(), is_image) ||
           std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return m.substrate.reflectance_image >= 0; });
}

} // namespace

std::uint64_t predicted_render_bytes(const Scene& scene, const WavelengthPlan& plan,
                                     const RenderOptions& options) {
    const auto pixels = static_cast<std::uint64_t>(scene.film.width) *
                        static_cast<std::uint64_t>(scene.film.height);
    const auto lanes = static_cast<std::uint64_t>(plan.padded_lanes());
    const std::uint64_t rows = options.band_variance ? 4 : 3;
    const std::uint64_t film = pixels * (rows * lanes + film_statistics_per_pixel) * 4;
    const std::uint64_t image = pixels * (static_cast<std::uint64_t>(plan.film.count) + 5) * 4;
    const std::uint64_t depth = static_cast<std::uint64_t>(scene.integrator.max_depth) + 1;
    const ModelBytes models = model_bytes(scene, plan, options.model);
    const std::uint64_t vertex = sizeof(VertexRecord) + sizeof(RayRecord) + models.vertex +
                                 (has_colours(scene) ? VERTEX_COLOURS * sizeof(float) : 0) +
                                 (plan.hero > 0 ? 8 * hero_width(plan.hero) : 0);
    const std::uint64_t paths =
        options.batch_paths * (depth * vertex + models.path + lanes * 4 + sizeof(RayRecord) +
                               sizeof(HitRecord) + sizeof(PathState));
    const std::uint64_t choosing =
        options.adaptive ? pixels * (2 * sizeof(PixelSamples) + sizeof(float)) : 0;
    // The film goes as the image comes, but for observers of passes, who see an image beside it; a
    // checkpoint is read as a whole.
    return film + image + (options.resume ? film : 0) + paths + choosing;
}

void check_render_memory(const Scene& scene, const WavelengthPlan& plan,
                         const RenderOptions& options) {
    const std::uint64_t limit = options.memory_limit_bytes
                                    ? options.memory_limit_bytes
                                    : machine_memory_bytes() / 5 * 4 /
                                          static_cast<std::uint64_t>(options.processes_on_machine);
    const std::uint64_t needed = predicted_render_bytes(scene, plan, options);
    if (needed > limit)
        throw_input_error(
            {scene.file.string()},
            fmt::format("the render would take {} bytes, the limit is {}", needed, limit),
            "make the film smaller, take fewer bands or raise --memory-limit");
}

} // namespace reradiant
