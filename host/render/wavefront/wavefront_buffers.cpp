#include "host/render/wavefront/wavefront_buffers.h"

#include "reradiant/error.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

template <typename T>
DeviceArray<T> filled(const Device& device, const char* name, const std::vector<T>& values,
                      std::uint64_t planned) {
    if (values.size() > planned)
        throw_runtime_error(
            fmt::format("{} holds {} elements, its plan says {}", name, values.size(), planned));
    return {device, std::span<const T>(values)};
}

} // namespace

WavefrontBuffers::WavefrontBuffers(const Device& device, const RenderPlan& plan,
                                   const SceneTables& scene) {
    const BufferCounts& counts = plan.counts;
#define BUFFER(type, name) name = filled(device, #name, scene.name, counts.name);
    SCENE_BUFFERS(BUFFER)
#undef BUFFER
    for (const std::vector<LightRecord>& layer : scene.layer_lights)
        layer_lights.push_back(filled(device, "layer_lights", layer, counts.layer_lights));
    film_bands = filled(device, "film_bands", plan.film.lane_bands, counts.film_bands);
    film_weights = filled(device, "film_weights", plan.film.lane_weights, counts.film_weights);
    y_weights = filled(device, "y_weights", plan.film.y_weights, counts.y_weights);
#define BUFFER(type, name) name = {device, counts.name};
    PATH_BUFFERS(BUFFER)
#undef BUFFER
}

std::size_t WavefrontBuffers::bytes() const {
    std::size_t bytes = 0;
#define BUFFER(type, name) bytes += name.bytes();
    RENDER_BUFFERS(BUFFER)
#undef BUFFER
    for (const DeviceArray<LightRecord>& layer : layer_lights)
        bytes += layer.bytes();
    return bytes;
}

} // namespace reradiant
