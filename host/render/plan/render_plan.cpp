#include "host/render/plan/render_plan.h"

#include "host/base/memory_limit.h"
#include "host/device/opencl_device.h"
#include "host/render/plan/material_plans.h"
#include "host/render/tables/hero_tables.h"
#include "kernels/core/features.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>

namespace reradiant {

namespace {

/// Chunks of events that walks have room for at first, for each path.
constexpr std::uint64_t walk_chunks_a_path = 4;

/// Bits that kernels get whether or not the scene needs them.
RenderFeatures forced_features(const RenderOptions& options) {
    if (options.all_features)
        return RenderFeatures::all();
    return options.also_on.empty() ? RenderFeatures{} : RenderFeatures::only(options.also_on);
}

bool is_plain(const Surface& surface) {
    return surface.textures.empty() && surface.normal_texture < 0 && surface.mixed_with < 0;
}

/// True for a mixture with another mixture.
bool is_nested(const Scene& scene, const Surface& surface) {
    return surface.mixed_with >= 0 &&
           scene.surfaces[static_cast<std::size_t>(surface.mixed_with)].mixed_with >= 0;
}

std::string model_note(const Material& material, const ModelChoice& choice) {
    const std::string note =
        fmt::format("material '{}': model {}", material.name, model_name(choice.model));
    return choice.reason.empty() ? note : note + ", " + choice.reason;
}

/// Floats of the images that textures show, each once.
std::uint64_t texture_floats(const Scene& scene) {
    std::uint64_t floats = 0;
    std::vector<bool> shown(scene.images.size(), false);
    for (const Texture& texture : scene.textures) {
        const auto image = static_cast<std::size_t>(texture.image);
        if (texture.image < 0 || shown[image])
            continue;
        shown[image] = true;
        floats += scene.images[image].rgb.size();
    }
    return floats;
}

/// Fills the plan of a render: first what takes no time, so that a render of absurd size is refused
/// at once.
class RenderPlanner {
public:
    RenderPlanner(const Scene& scene, const RenderOptions& options, WavelengthPlan wavelengths)
        : scene_(scene), options_(options), forced_(forced_features(options)) {
        plan_.wavelengths = std::move(wavelengths);
        plan_.pixels = static_cast<std::uint64_t>(scene.film.width) *
                       static_cast<std::uint64_t>(scene.film.height);
        plan_.max_depth = static_cast<std::uint32_t>(scene.integrator.max_depth);
        plan_.min_depth = static_cast<std::uint32_t>(scene.integrator.min_depth);
        plan_.seed = options.seed;
        // The camera's numbers, and those for light and direction at the first three vertices, come
        // from the sequence: later ones are smoothed by those before them. Variances per band are
        // those of independent samples, so that parts of a render can be put together.
        plan_.sequence_blocks = options.band_variance ? 0 : 7;
        plan_.film = film_shape(plan_.wavelengths, options.band_variance || forced_.band_variance,
                                forced_.scatter);
        choose_models();
    }

    /// Bytes of film, paths and image, if no light is black.
    std::uint64_t least_bytes() {
        plan_.features = features(features_of_lights(scene_));
        count_paths();
        count_film(options_.light_groups ? most_light_layers(scene_) : 0);
        return plan_.device_bytes() + plan_.host_bytes;
    }

    RenderPlan plan() {
        check_memory(least_bytes());
        plan_.film = film_layout(plan_.wavelengths, plan_.film.band_variance, plan_.film.scatter);
        plan_.film.independent_samples = plan_.sequence_blocks == 0;
        plan_.film.begins_odd = options_.first_sample % 2 == 1;
        plan_.lights = plan_lights(scene_, plan_.wavelengths, options_.light_groups);
        plan_materials(scene_, plan_.wavelengths, plan_.materials);
        plan_.features = features(plan_.lights.features);
        find_passed_sheets();
        count_paths();
        count_film(plan_.lights.layers.size());
        count_tables();
        check_memory(plan_.device_bytes() + plan_.host_bytes);
        return std::move(plan_);
    }

private:
    void choose_models() {
        const bool hero = plan_.wavelengths.hero > 0;
        for (const Material& material : scene_.materials) {
            MaterialPlan chosen;
            chosen.choice = choose_model(material, options_.model,
                                         hero ? ModelUse::RenderHero : ModelUse::Render);
            if (hero && chosen.choice.model == Model::Walk) // it meets its substrate several times
                throw_input_error(
                    material.position,
                    fmt::format(
                        "material '{}' is walked through, which --wavelengths hero cannot do",
                        material.name),
                    "take --wavelengths comb, or --model adding or weidlich-wilkie");
            chosen.features = features_of_model(material, chosen.choice.model);
            plan_.notes.push_back(model_note(material, chosen.choice));
            plan_.materials.push_back(std::move(chosen));
        }
    }

    /// Shadow rays pass smooth sheets whose material does not hang on a texture's chance.
    void find_passed_sheets() {
        std::vector<std::uint32_t> passed;
        const std::vector<Surface> surfaces =
            scene_.surfaces.empty() ? plain_surfaces(scene_) : scene_.surfaces;
        const auto is_mixed_in = [&](std::size_t s) {
            return std::ranges::any_of(surfaces, [&](const Surface& other) {
                return other.mixed_with == static_cast<int>(s);
            });
        };
        bool any = false;
        for (std::size_t s = 0; s < surfaces.size(); ++s) {
            const auto material = static_cast<std::size_t>(surfaces[s].first_material);
            const bool is_passed =
                plan_.materials[material].is_straight && is_plain(surfaces[s]) && !is_mixed_in(s);
            passed.push_back(is_passed ? static_cast<std::uint32_t>(material) : NO_INDEX);
            any = any || is_passed;
        }
        plan_.features.passed_sheets =
            forced_.passed_sheets || (any && plan_.features.samples_lights());
        if (plan_.features.passed_sheets)
            plan_.passed_sheets = std::move(passed);
    }

    /// All that is known so far of the materials, and the lights.
    RenderFeatures features(const RenderFeatures& lights) const {
        RenderFeatures all = forced_;
        all.add(lights);
        for (const MaterialPlan& material : plan_.materials)
            all.add(material.features);
        all.lens |= scene_.camera.lens_radius > 0.0;
        all.textures |= !std::all_of(scene_.surfaces.begin(), scene_.surfaces.end(), is_plain);
        all.nested_mixtures |= std::ranges::any_of(
            scene_.surfaces, [&](const Surface& surface) { return is_nested(scene_, surface); });
        all.scatter = plan_.film.scatter;
        all.band_variance = plan_.film.band_variance;
        all.chunks = plan_.wavelengths.padded_lanes() / WIDTH;
        all.film_chunks = plan_.film.lanes / WIDTH;
        all.hero = plan_.wavelengths.hero;
        all.walk &= all.hero == 0;
        all.dyes &= all.hero == 0;
        all.in_double = options_.in_double;
        return all;
    }

    void count_paths() {
        const RenderFeatures& features = plan_.features;
        const std::uint64_t paths = std::min<std::uint64_t>(
            std::max<std::size_t>(options_.batch_paths, 1), plan_.pixels * 1024);
        plan_.path_capacity = static_cast<std::uint32_t>(paths);
        plan_.depths = plan_.max_depth + (features.has_emitters_to_meet() ? 1 : 0);
        const std::uint64_t vertices = paths * plan_.depths;
        BufferCounts& counts = plan_.counts;
        counts.rays = counts.hits = counts.paths = counts.goes_on = paths;
        counts.live = 2 * paths;
        counts.radiance = paths * lanes();
        counts.vertices = vertices;
        counts.shadow_rays = features.samples_lights() ? vertices : 0;
        counts.crossings = features.passed_sheets ? vertices * MOST_CROSSINGS : 0;
        counts.colours = features.has_colours() ? vertices * VERTEX_COLOURS : 0;
        counts.lobe_weights = vertices * 2 * static_cast<std::uint64_t>(features.lobes);
        counts.walk_vertices = features.walk ? vertices : 0;
        counts.walk_chunks = features.walk ? paths * walk_chunks_a_path : 0;
        counts.walk_chunks_used = features.walk ? 1 : 0;
        counts.hero_lanes = counts.hero_weights =
            features.hero > 0
                ? (vertices + paths) * static_cast<std::uint64_t>(hero_width(features.hero))
                : 0;
        counts.chosen = options_.adaptive ? plan_.pixels : 0;
    }

    /// The film goes as the image comes, but for observers of passes, who see an image beside it; a
    /// checkpoint is read as a whole.
    void count_film(std::uint64_t layers) {
        const auto bands = static_cast<std::uint64_t>(plan_.wavelengths.film.count);
        const std::uint64_t row = static_cast<std::uint64_t>(plan_.wavelengths.phases) * lanes();
        BufferCounts& counts = plan_.counts;
        counts.sums = (1 + layers) * plan_.pixels * plan_.film.floats_per_pixel();
        counts.statistics = (1 + layers) * plan_.pixels * film_statistics_per_pixel;
        counts.film_bands = row;
        counts.film_weights = 2 * row;
        counts.y_weights = static_cast<std::uint64_t>(plan_.film.lanes);
        // values, variances by their two estimates, counts; what each pixel adds to the error
        std::uint64_t floats =
            plan_.pixels * ((plan_.film.band_variance ? 3 : 1) * bands + 3 + layers * bands);
        if (options_.adaptive)
            floats += plan_.pixels * (1 + sizeof(PixelSamples) / sizeof(float));
        if (options_.resume)
            floats += counts.sums + counts.statistics;
        plan_.host_bytes = floats * sizeof(float);
    }

    void count_tables() {
        BufferCounts& counts = plan_.counts;
        counts.surfaces =
            scene_.surfaces.empty() ? scene_.materials.size() : scene_.surfaces.size();
        counts.textures = scene_.textures.size();
        counts.lights = scene_.lights.size();
        counts.layer_lights = plan_.lights.layers.size() * counts.lights;
        counts.tables = plan_.lights.floats + texture_floats(scene_);
        const std::uint64_t choices = static_cast<std::uint64_t>(choice_count(plan_.features)) + 1;
        counts.materials = 0;
        for (const MaterialPlan& material : plan_.materials) {
            counts.materials += material.counts.materials;
            counts.layers += material.counts.layers;
            counts.lobes += material.counts.lobes;
            counts.walk_parts += material.counts.walk_parts;
            counts.tables += material.counts.floats;
            if (material.choice.model != Model::Walk)
                counts.tables += material.counts.materials * TABLE_NODES * choices;
        }
        plan_.host_bytes += counts.tables * sizeof(float);
    }

    void check_memory(std::uint64_t needed) const {
        const std::uint64_t limit =
            options_.memory_limit_bytes
                ? options_.memory_limit_bytes
                : machine_memory_bytes() / 5 * 4 /
                      static_cast<std::uint64_t>(options_.processes_on_machine);
        if (needed > limit)
            throw_input_error(
                {scene_.file.string()},
                fmt::format("the render would take {} bytes, the limit is {}", needed, limit),
                "make the film smaller, take fewer bands or raise --memory-limit");
    }

    std::uint64_t lanes() const {
        return static_cast<std::uint64_t>(plan_.wavelengths.padded_lanes());
    }

    const Scene& scene_;
    const RenderOptions& options_;
    RenderFeatures forced_;
    RenderPlan plan_;
};

} // namespace

std::uint64_t RenderPlan::device_bytes() const {
    std::uint64_t bytes = 0;
    for (const BufferPlan& buffer : buffers())
        bytes += buffer.bytes();
    return bytes;
}

std::vector<std::string> RenderPlan::left_out() const {
    std::vector<std::string> lines = features.left_out();
    lines.insert(lines.end(), wavelengths.left_out.begin(), wavelengths.left_out.end());
    return lines;
}

RenderPlan plan_render(const Scene& scene, const DeviceInfo& device, const RenderOptions& options) {
    if (options.in_double)
        check_double(device);
    return RenderPlanner(scene, options,
                         plan_wavelengths(scene, options.bands.value_or(film_bands(scene)),
                                          options.wavelengths))
        .plan();
}

std::uint64_t predicted_render_bytes(const Scene& scene, const WavelengthPlan& plan,
                                     const RenderOptions& options) {
    return RenderPlanner(scene, options, plan).least_bytes();
}

} // namespace reradiant
