#include "host/study/converge.h"

#include "host/error.h"
#include "host/render/scene_tables.h"
#include "host/scene/sha256.h"
#include "host/study/converge_store.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// Two rows a doubling of time.
constexpr double time_ratio = std::numbers::sqrt2;
constexpr double reference_time_factor = 10.0;
constexpr std::uint32_t unlimited_samples = 1u << 30;

RenderOptions method_options(const ConvergeOptions& options, const RenderMethod& method,
                             std::uint32_t seed) {
    RenderOptions render = options.render;
    render.model = method.model;
    render.wavelengths.comb_count = method.comb_count;
    render.wavelengths.hero_count = method.hero_count;
    render.adaptive = method.adaptive;
    render.samples = unlimited_samples;
    render.time_seconds = options.time_seconds;
    render.seed = seed;
    return render;
}

/// Refuses a model that some material cannot be rendered by. The coarsest comb does for that.
void check_methods(const Scene& scene, const ConvergeOptions& options) {
    WavelengthPlan plan =
        plan_wavelengths(scene, options.render.bands.value_or(film_bands(scene)), {1});
    for (const RenderMethod& method : options.methods) {
        plan.hero = method.hero_count;
        try {
            build_scene_tables(scene, plan, method.model);
        } catch (const Error& error) {
            throw_input_error({scene.file.string()},
                              fmt::format("cannot be rendered by the method '{}': {}", method.name,
                                          error.what()));
        }
    }
}

void check_reference(const Reference& reference, const Scene& scene, const WavelengthGrid& bands) {
    const SpectralImage& image = reference.image;
    const SourcePosition at{reference.file.string()};
    if (image.width != scene.film.width || image.height != scene.film.height)
        throw_input_error(at,
                          fmt::format("the reference has {} x {} pixels, the scene's film {} x {}",
                                      image.width, image.height, scene.film.width,
                                      scene.film.height),
                          "render the reference from the same scene");
    const bool alike = image.bands.count == bands.count &&
                       std::abs(image.bands.from_nm - bands.from_nm) <= 1e-5 &&
                       std::abs(image.bands.step_nm - bands.step_nm) <= 1e-5;
    if (!alike)
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

std::string sha256_of(const std::string& text) {
    Sha256 digest;
    digest.update(text);
    return digest.hex();
}

/// What every image of this run depends on.
std::string common_identity(const Scene& scene, const Device& device,
                            const ConvergeOptions& options) {
    const WavelengthGrid bands = options.render.bands.value_or(film_bands(scene));
    return fmt::format("{} {}:{}:{} {}", scene.hash, bands.from_nm, bands.count, bands.step_nm,
                       device.info().name);
}

double share_of_reference(const ConvergeOptions& options) {
    return reference_time_factor /
           (reference_time_factor + static_cast<double>(options.methods.size()));
}

/// One run: the reference, then the methods one after the other.
class Run {
public:
    Run(const Scene& scene, const Device& device, const ConvergeOptions& options,
        const StudyProgress& progress)
        : scene_(scene), device_(device), options_(options), progress_(progress) {}

    ConvergeResult result() {
        if (options_.reference.empty())
            make_reference();
        else
            read_reference();
        for (std::size_t k = 0; k < options_.methods.size() && !result_.interrupted; ++k)
            add_method(k);
        return std::move(result_);
    }

private:
    void read_reference() {
        Reference& reference = result_.reference;
        reference.file = options_.reference;
        reference.image = read_spectral_exr(options_.reference);
        check_reference(reference, scene_, options_.render.bands.value_or(film_bands(scene_)));
        Sha256 digest;
        digest.update({reinterpret_cast<const char*>(reference.image.values.data()),
                       reference.image.values.size() * sizeof(float)});
        reference.identity = digest.hex();
        // The same random numbers would make an image agree with its reference too well.
        result_.seed = options_.render.seed;
        const auto seed = reference.image.attributes.find("reradiant:seed");
        if (seed != reference.image.attributes.end() &&
            seed->second == std::to_string(result_.seed)) {
            ++result_.seed;
            spdlog::info("{}: has the seed {}; the methods take {}", reference.file.string(),
                         options_.render.seed, result_.seed);
        }
    }

    void make_reference() {
        result_.seed = options_.render.seed;
        RenderOptions render = method_options(options_, {}, ~result_.seed);
        render.time_seconds = options_.reference_samples > 0
                                  ? std::numeric_limits<double>::infinity()
                                  : reference_time_factor * options_.time_seconds;
        if (options_.reference_samples > 0)
            render.samples = options_.reference_samples;
        const std::string identity =
            sha256_of(fmt::format("{} {} {} {}", common_identity(scene_, device_, options_),
                                  render.seed, render.samples, render.time_seconds));
        if (auto kept = kept_reference(options_.folder, identity)) {
            result_.reference = std::move(*kept);
            return;
        }
        const double share = share_of_reference(options_);
        RenderResult rendered = render_until(render, 0.0, share, "reference",
                                             [](const RenderProgress&, const auto&) {});
        if (result_.interrupted)
            return;
        const RenderProgress& last = rendered.passes.back();
        result_.reference = {std::move(rendered.image),
                             {},
                             identity,
                             {last.relmse, last.relmse_low, last.relmse_high}};
        result_.reference.image.attributes["reradiant:seed"] = std::to_string(render.seed);
        keep_reference(options_.folder, result_.reference);
    }

    /// Renders with progress from `share` on; sets `interrupted` when it was stopped.
    RenderResult render_until(const RenderOptions& render, double share, double share_of_all,
                              const std::string& name, const RenderObserver& observe) {
        const auto progress = [&](const RenderProgress& state) {
            const double done = std::max(state.seconds / render.time_seconds,
                                         static_cast<double>(state.samples) / render.samples);
            const bool goes_on = progress_(
                share + share_of_all * std::min(1.0, done),
                fmt::format("{}: {} spp, relMSE {:.2g}", name, state.samples, state.relmse));
            result_.interrupted = !goes_on;
            return goes_on;
        };
        return reradiant::render(scene_, device_, render, progress, observe);
    }

    void add_method(std::size_t index) {
        const RenderMethod& method = options_.methods[index];
        const std::string identity = sha256_of(fmt::format(
            "{} {} {} {} {}", common_identity(scene_, device_, options_),
            result_.reference.identity, result_.seed, options_.time_seconds, method.name));
        if (auto kept = kept_method(options_.folder, identity, method)) {
            result_.methods.push_back(std::move(*kept));
            return;
        }
        const double all = options_.reference.empty() ? 1.0 - share_of_reference(options_) : 1.0;
        const double share = all / static_cast<double>(options_.methods.size());
        MethodResult result =
            measured(method, 1.0 - all + share * static_cast<double>(index), share);
        if (result_.interrupted)
            return;
        keep_method(options_.folder, identity, result);
        result_.methods.push_back(std::move(result));
    }

    MethodResult measured(const RenderMethod& method, double share, double share_of_all) {
        MethodResult result;
        result.curve.method = method;
        double next_seconds = 0.0;
        const auto observe = [&](const RenderProgress& state, const auto& image) {
            if (state.seconds < std::min(next_seconds, options_.time_seconds))
                return;
            next_seconds = time_ratio * state.seconds;
            result.curve.rows.push_back({state.seconds,
                                         0.0,
                                         state.samples,
                                         compare_images(image(), result_.reference.image),
                                         {state.relmse, state.relmse_low, state.relmse_high}});
        };
        const RenderOptions render = method_options(options_, method, result_.seed);
        const double setup_and_pass = warm_up(render, result.curve);
        RenderResult rendered = render_until(render, share, share_of_all, method.name, observe);
        result.curve.setup_seconds =
            std::max(0.0, setup_and_pass - rendered.passes.front().seconds);
        for (CurveRow& row : result.curve.rows)
            row.seconds_with_setup = row.seconds + result.curve.setup_seconds;
        result.image = std::move(rendered.image);
        return result;
    }

    /// Renders one sample and returns the seconds it took. Drivers build kernels when they are
    /// first run, so that without this the first method to need one would pay for it as rendering.
    double warm_up(RenderOptions render, ErrorCurve& curve) const {
        render.samples = 1;
        const RenderResult warm = reradiant::render(scene_, device_, render);
        curve.build_seconds = warm.build_seconds;
        return warm.total_seconds;
    }

    const Scene& scene_;
    const Device& device_;
    const ConvergeOptions& options_;
    const StudyProgress& progress_;
    ConvergeResult result_;
};

} // namespace

ConvergeResult converge(const Scene& scene, const Device& device, const ConvergeOptions& options,
                        const StudyProgress& progress) {
    check_methods(scene, options);
    return Run(scene, device, options, progress).result();
}

} // namespace reradiant
