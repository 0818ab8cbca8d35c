#pragma once

#include "host/render/plan/render_features.h"
#include "host/scene/model/model_choice.h"
#include "kernels/core/shared.h"
#include "reradiant/wavelength_plan.h"

#include <string>
#include <vector>

namespace reradiant {

/// Everything the kernels read about a scene's materials, lights and camera. Offsets in the
/// records are into `tables`, in floats.
struct SceneTables {
    CameraRecord camera{};
    std::vector<MaterialRecord> materials;
    std::vector<LayerRecord> layers;
    std::vector<LobeRecord> lobes;
    std::vector<SurfaceRecord> surfaces;
    std::vector<TextureRecord> textures;
    std::vector<LightRecord> lights;
    std::vector<WalkPartRecord> walk_parts; ///< parts of the materials that are walked through
    std::vector<float> tables;
    std::uint32_t sampled_lights = 0; ///< lights that light sampling can choose, first in `lights`
    std::uint32_t environment = NO_INDEX; ///< light that holds the constant environments' spectrum
    EnvironmentRecord image{NO_INDEX, 0, 0, 0, 0, 0, 0, 0.0f}; ///< the environment image
    RenderFeatures features;
    std::vector<std::string> notes; ///< models chosen, factorisation errors
};

/// Appends the tables of one material; sets the feature bits it needs. lobes: most deeper lobes of
/// any material of the scene.
void append_material(const Material& material, Model model, const WavelengthPlan& plan, int lobes,
                     SceneTables& tables);

/// Appends surfaces, textures and the images of these; sets the feature bits they need.
void append_surfaces(const Scene& scene, SceneTables& tables);

/// Appends all lights; sets the feature bits they need.
void append_lights(const Scene& scene, const WavelengthPlan& plan, SceneTables& tables);

CameraRecord camera_record(const Camera& camera, const FilmSettings& film);

/// Returns the use that models are chosen for in a picture with this plan: whether or not it
/// samples hero wavelengths.
ModelUse use_in(const WavelengthPlan& plan);

/// `model` other than Auto replaces every material's own; `at_least`: bits that are set anyway.
SceneTables build_scene_tables(const Scene& scene, const WavelengthPlan& plan, Model model,
                               const RenderFeatures& at_least = {});

} // namespace reradiant
