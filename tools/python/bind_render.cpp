#include "host/render/film/render_statistics.h"
#include "host/render/plan/wavelength_text.h"
#include "host/render/wavefront/render_hooks.h"
#include "host/scene/toml/scene_table.h"
#include "reradiant/device.h"
#include "reradiant/render.h"
#include "reradiant/scene_file.h"
#include "tools/python/bindings.h"
#include "tools/python/call.h"
#include "tools/python/values.h"

#include <pybind11/stl.h>

#include <memory>
#include <utility>

namespace py = pybind11;

namespace reradiant::python {

namespace {

RenderOptions options_from(const py::dict& given) {
    RenderOptions options;
    options.samples = given["samples"].cast<std::uint32_t>();
    options.first_sample = given["first_sample"].cast<std::uint32_t>();
    options.time_seconds = given["time"].cast<double>();
    options.relmse = given["error"].cast<double>();
    options.seed = given["seed"].cast<std::uint32_t>();
    options.threads = given["threads"].cast<int>();
    options.model = model_from_name(given["model"].cast<std::string>());
    options.wavelengths = wavelengths_from_text(given["wavelengths"].cast<std::string>());
    options.wavelengths.centred = given["centred"].cast<bool>();
    options.all_features = given["all_features"].cast<bool>();
    options.wavelengths.keep_all = options.all_features;
    options.adaptive = given["adaptive"].cast<bool>();
    options.band_variance = given["band_variance"].cast<bool>();
    options.memory_limit_bytes = given["memory_limit"].cast<std::uint64_t>();
    if (!given["bands"].is_none())
        options.bands = grid_from(given["bands"].cast<py::tuple>());
    return options;
}

/// The image and what the program's --json says.
struct Rendered {
    std::shared_ptr<SpectralImage> image;
    nlohmann::ordered_json statistics;
};

Rendered render_source(const Source& source, RenderOptions options, const std::string& device_name,
                       const std::string& model, StopFlag stop) {
    const RenderHooks hooks{.time_counts_from = std::chrono::steady_clock::now()};
    options.hooks = &hooks;
    const Scene scene =
        source.table ? scene_from_table(*source.table, source.file) : load_scene(source.file);
    prepare_opencl(options.threads);
    const Device device(device_name);
    RenderResult result =
        render(scene, device, options, [stop](const RenderProgress&) { return !is_stopped(stop); });
    throw_if_stopped(stop);
    describe_image(result, scene, device, options, "reradiant.render");
    nlohmann::ordered_json statistics = render_statistics(result, device, model);
    return {std::make_shared<SpectralImage>(std::move(result.image)), std::move(statistics)};
}

py::tuple render_scene(const py::object& scene, const py::dict& given) {
    const Source source = source_from(scene);
    const RenderOptions options = options_from(given);
    const auto device = given["device"].cast<std::string>();
    const auto model = given["model"].cast<std::string>();
    Rendered rendered = interruptible(
        [&](StopFlag stop) { return render_source(source, options, device, model, stop); });
    return py::make_tuple(rendered.image, python_value(rendered.statistics));
}

py::list devices() {
    prepare_opencl(0);
    py::list names;
    for (const DeviceInfo& device : list_devices())
        names.append(device.name);
    return names;
}

} // namespace

void bind_render(py::module_& module) {
    module.def("render", &render_scene);
    module.def("devices", &devices);
}

} // namespace reradiant::python
