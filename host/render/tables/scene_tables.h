#pragma once

#include "host/render/plan/render_plan.h"
#include "host/render/tables/stack_optics.h"
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
    std::vector<std::vector<LightRecord>> layer_lights; ///< `lights` as each layer is lit by them
    std::vector<WalkPartRecord> walk_parts; ///< parts of the materials that are walked through
    std::vector<float> tables;
    std::uint32_t sampled_lights = 0; ///< lights that light sampling can choose, first in `lights`
    std::uint32_t environment = NO_INDEX; ///< light that holds the constant environments' spectrum
    EnvironmentRecord image{NO_INDEX, 0, 0, 0, 0, 0, 0, 0.0f}; ///< the environment image
    std::vector<std::string> notes; ///< models chosen, factorisation errors
};

/// Appends the tables of one material with a closed model. `features` are those of the scene.
void append_material(const Material& material, const MaterialPlan& plan,
                     const WavelengthPlan& wavelengths, const RenderFeatures& features,
                     const MaterialOptics& optics, SceneTables& tables);

/// Appends the other side of a sheet, whose record from above has the index `above`.
void append_other_side(const Material& material, const MaterialPlan& plan,
                       const WavelengthPlan& wavelengths, const RenderFeatures& features,
                       const MaterialOptics& optics, std::size_t above, SceneTables& tables);

/// Appends surfaces, textures and the images of these.
void append_surfaces(const Scene& scene, SceneTables& tables);

/// Appends all lights.
void append_lights(const Scene& scene, const LightPlan& plan, SceneTables& tables);

CameraRecord camera_record(const Camera& camera, const FilmSettings& film);

/// Writes what the plan of a scene foresees.
SceneTables build_scene_tables(const Scene& scene, const RenderPlan& plan);

} // namespace reradiant
