#include "host/study/converge/converge_checks.h"

#include "host/render/tables/scene_tables.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

bool has_size_of(const SpectralImage& image, const Scene& scene) {
    return image.width == scene.film.width && image.height == scene.film.height;
}

bool has_bands(const SpectralImage& image, const WavelengthGrid& bands) {
    return image.bands.count == bands.count &&
           std::abs(image.bands.from_nm - bands.from_nm) <= 1e-5 &&
           std::abs(image.bands.step_nm - bands.step_nm) <= 1e-5;
}

} // namespace

void check_methods(const Scene& scene, const ConvergeOptions& options) {
    RenderOptions render = options.render;
    render.in_double = false; // whether there is the memory or the device for it is not asked here
    render.memory_limit_bytes = std::numeric_limits<std::uint64_t>::max();
    for (const RenderMethod& method : options.methods) {
        render.model = method.model;
        render.wavelengths = {1, method.hero_count};
        try {
            build_scene_tables(scene, plan_render(scene, {}, render));
        } catch (const Error& error) {
            throw_input_error({scene.file.string()},
                              fmt::format("cannot be rendered by the method '{}': {}", method.name,
                                          error.what()));
        }
    }
}

bool is_of_film(const SpectralImage& image, const Scene& scene, const WavelengthGrid& bands) {
    return has_size_of(image, scene) && has_bands(image, bands);
}

void check_reference(const Reference& reference, const Scene& scene, const WavelengthGrid& bands) {
    const SpectralImage& image = reference.image;
    const SourcePosition at{reference.file.string()};
    if (!has_size_of(image, scene))
        throw_input_error(at,
                          fmt::format("the reference has {} x {} pixels, the scene's film {} x {}",
                                      image.width, image.height, scene.film.width,
                                      scene.film.height),
                          "render the reference from the same scene");
    if (!has_bands(image, bands))
        throw_input_error(
            at,
            fmt::format("the reference has the bands {}:{}:{} nm, the scene {}:{}:{} nm",
                        image.bands.from_nm, image.bands.to_nm(), image.bands.step_nm,
                        bands.from_nm, bands.to_nm(), bands.step_nm),
            "render the reference with the same bands");
    if (!std::all_of(image.values.begin(), image.values.end(),
                     [](float value) { return std::isfinite(value); }))
        throw_input_error(at, "the reference holds values that are not finite",
                          "no error can be stated against it");
}

} // namespace reradiant
