#pragma once

#include "reradiant/scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// Reads a scene file with everything it names (tools/docs/scene-files.md), or an XML
/// file of Mitsuba 3 (host/scene/mitsuba/mitsuba_import.h). Unknown
/// keys, wrong types and lengths, out-of-range numbers and unreadable references throw an input
/// Error at their place. Warnings go to the log.
Scene load_scene(const std::filesystem::path& file);

/// Names that `preset = "..."` takes, sorted: the files of spectra/materials.
std::vector<std::string> preset_names();

/// Reads a MATERIAL.toml with one [material]. One material stands at one point: textures are taken
/// at t = 1/2 and a mixture is left out, which the log says. The log warns of spectra that are used
/// outside their data: on `bands`, without them on the grid of the material's matrices or else over
/// the default range.
Material load_material(const std::filesystem::path& file,
                       const std::optional<WavelengthGrid>& bands = {});

/// The layers of a MATERIAL.toml, whose substrate may be anything or absent: what lay above a
/// sample that was measured through them. Input Error with the place, also for dyes in the layers
/// and for a sheet, since neither can be looked through to a substrate.
LayerStack load_stack(const std::filesystem::path& file);

} // namespace reradiant
