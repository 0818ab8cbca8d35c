#include "host/render/film/render_statistics.h"

#include "host/render/checkpoint/render_identity.h"
#include "reradiant/merge.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sys/resource.h>

namespace reradiant {

namespace {

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// Numbers that JSON has no name for become null.
nlohmann::ordered_json finite_or_null(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

/// Samples that were accepted of the pixel with the fewest and of that with the most.
nlohmann::ordered_json sample_range(const SpectralImage& image) {
    const auto [least, most] = std::ranges::minmax(image.sample_count);
    return {static_cast<std::uint64_t>(least), static_cast<std::uint64_t>(most)};
}

nlohmann::ordered_json layers_json(const RenderResult& result) {
    nlohmann::ordered_json layers = nlohmann::ordered_json::array();
    for (const LightLayer& layer : result.light_layers) {
        const double sum = std::accumulate(layer.values.begin(), layer.values.end(), 0.0);
        layers.push_back({{"name", layer.name()},
                          {"from_nm", layer.from_nm},
                          {"to_nm", layer.to_nm},
                          {"mean_radiance", sum / static_cast<double>(layer.values.size())}});
    }
    return layers;
}

} // namespace

nlohmann::ordered_json render_statistics(const RenderResult& result, const Device& device,
                                         const std::string& model) {
    const double rendering = result.trace_seconds + result.shade_seconds;
    const WavelengthPlan& plan = result.plan;
    nlohmann::ordered_json passes = nlohmann::ordered_json::array();
    for (const RenderProgress& pass : result.passes)
        passes.push_back({{"spp", pass.samples},
                          {"seconds", pass.seconds},
                          {"relmse", finite_or_null(pass.relmse)},
                          {"relmse_low", pass.relmse_low},
                          {"relmse_high", finite_or_null(pass.relmse_high)}});
    nlohmann::ordered_json features;
    for (const auto& [name, on] : result.features)
        features[name] = on ? "on" : "off";
    return {
        {"spp", result.samples},
        {"resumed_spp", result.resumed_samples},
        {"seconds",
         {{"setup", result.setup_seconds},
          {"build", result.build_seconds},
          {"trace", result.trace_seconds},
          {"shade", result.shade_seconds},
          {"total", result.total_seconds}}},
        {"stage_seconds", result.stage_seconds},
        {"paths", result.paths},
        {"rays", result.rays},
        {"paths_per_second", rendering > 0.0 ? static_cast<double>(result.paths) / rendering : 0.0},
        {"relmse", finite_or_null(result.relmse)},
        {"spp_range", sample_range(result.image)},
        {"non_finite", result.non_finite},
        {"light_layers", layers_json(result)},
        {"device", device.info().name},
        {"bands",
         {{"from", plan.film.from_nm},
          {"to", plan.film.to_nm()},
          {"step", plan.film.step_nm},
          {"count", plan.film.count}}},
        {"model", model},
        {"wavelengths",
         {{"sampling", plan.hero > 0 ? "hero" : "comb"},
          {"count", plan.hero > 0 ? plan.hero : plan.comb.count},
          {"cells", plan.comb.count},
          {"from", plan.comb.from_nm},
          {"step", plan.comb.step_nm},
          {"phases", plan.phases},
          {"lines", plan.lanes.size() - static_cast<std::size_t>(plan.comb.count)}}},
        {"features", features},
        {"left_out", result.left_out},
        {"notes", result.notes},
        {"passes", passes},
        {"kernels",
         {{"built", result.build.built},
          {"from_cache", result.build.from_cache},
          {"source_bytes", result.build.source_bytes}}},
        {"device_bytes", result.device_bytes},
        {"mapped_bytes", result.mapped_bytes},
        {"table_bytes", result.table_bytes},
        {"peak_memory_bytes", peak_memory_bytes()}};
}

void describe_image(RenderResult& result, const Scene& scene, const Device& device,
                    const RenderOptions& options, const std::string& command_line) {
    auto& attributes = result.image.attributes;
    attributes["reradiant:scene"] = scene.file.filename().string();
    attributes["reradiant:sceneHash"] = scene.hash;
    attributes["reradiant:seed"] = std::to_string(options.seed);
    attributes["reradiant:firstSample"] = std::to_string(options.first_sample);
    attributes["reradiant:samples"] = std::to_string(result.samples);
    if (!options.adaptive) // else pixels hold different ranges, and nothing can be merged with it
        attributes[sample_ranges_attribute] =
            sample_ranges_text({{options.first_sample, options.first_sample + result.samples}});
    attributes[sampling_attribute] = identity_text(sampling_identity(scene, options));
    attributes[render_identity_attribute] =
        identity_digest(render_identity(scene, device, options));
    attributes["reradiant:device"] = device.info().name;
    attributes["reradiant:commandLine"] = command_line;
}

} // namespace reradiant
