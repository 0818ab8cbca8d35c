#include "host/study/converge/converge.h"

#include "host/base/logging.h"
#include "host/render/wavefront/team_render.h"
#include "host/scene/model/sha256.h"
#include "host/study/converge/converge_checks.h"
#include "host/study/converge/converge_store.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <numbers>

namespace reradiant {

namespace {

/// Two rows a doubling of time.
constexpr double time_ratio = std::numbers::sqrt2;
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

std::string sha256_of(const std::string& text) {
    Sha256 digest;
    digest.update(text);
    return digest.hex();
}

/// Returns a text that names what every image of this run depends on.
std::string common_identity(const Scene& scene, const Device& device,
                            const ConvergeOptions& options) {
    const WavelengthGrid bands = options.render.bands.value_or(film_bands(scene));
    return fmt::format("{} {}:{}:{} {}", scene.hash, bands.from_nm, bands.count, bands.step_nm,
                       device.info().name);
}

double share_of_reference(const ConvergeOptions& options) {
    const double reference = reference_seconds(options);
    return reference /
           (reference + options.time_seconds * static_cast<double>(options.methods.size()));
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
        if (options_.team != nullptr && !result_.interrupted)
            share_methods(*options_.team);
        else
            for (std::size_t k = 0; k < options_.methods.size() && !result_.interrupted; ++k)
                add_method(k);
        return std::move(result_);
    }

private:
    WavelengthGrid bands() const { return options_.render.bands.value_or(film_bands(scene_)); }

    void read_reference() {
        Reference& reference = result_.reference;
        reference.file = options_.reference;
        reference.image = read_spectral_exr(options_.reference);
        check_reference(reference, scene_, bands());
        Sha256 digest;
        digest.update({reinterpret_cast<const char*>(reference.image.values.data()),
                       reference.image.values.size() * sizeof(float)});
        reference.identity = digest.hex();
        // The methods take another seed than the reference: with the same random numbers an image
        // would agree with it too well.
        result_.seed = options_.render.seed;
        const auto seed = reference.image.attributes.find("reradiant:seed");
        if (seed != reference.image.attributes.end() &&
            seed->second == std::to_string(result_.seed)) {
            ++result_.seed;
            logging::info("{}: has the seed {}; the methods take {}", reference.file.string(),
                          options_.render.seed, result_.seed);
        }
    }

    void make_reference() {
        result_.seed = options_.render.seed;
        RenderOptions render = method_options(options_, {}, ~result_.seed);
        render.time_seconds = options_.reference_samples > 0
                                  ? std::numeric_limits<double>::infinity()
                                  : reference_seconds(options_);
        if (options_.reference_samples > 0)
            render.samples = options_.reference_samples;
        const std::string identity =
            sha256_of(fmt::format("{} {} {} {}", common_identity(scene_, device_, options_),
                                  render.seed, render.samples, render.time_seconds));
        if (auto kept = kept_reference(options_.folder, identity);
            kept && is_of_film(kept->image, scene_, bands())) {
            result_.reference = std::move(*kept);
            return;
        }
        keep_as(render, options_.folder / "reference.exr");
        const double share = share_of_reference(options_);
        RenderResult rendered = render_until(render, 0.0, share, "reference", {}, options_.team);
        if (options_.team != nullptr)
            result_.interrupted = options_.team->from_leader(rendered.interrupted) != 0;
        if (result_.interrupted)
            return;
        if (rendered.image.values.empty()) { // only the leader has the image
            await_leader();
            auto kept = kept_reference(options_.folder, identity);
            if (!kept)
                refuse_folder("the reference");
            result_.reference = std::move(*kept);
            return;
        }
        const RenderProgress& last = rendered.passes.back();
        result_.reference = {std::move(rendered.image),
                             {},
                             identity,
                             {last.relmse, last.relmse_low, last.relmse_high}};
        result_.reference.image.attributes["reradiant:seed"] = std::to_string(render.seed);
        keep_reference(options_.folder, result_.reference);
        remove_checkpoint(options_.folder / "reference.exr");
        await_leader();
    }

    [[noreturn]] void refuse_folder(const std::string& missing) const {
        throw_runtime_error(
            fmt::format("{}: {} of another member is not there", options_.folder.string(), missing),
            "give all machines the same folder");
    }

    /// Nobody goes on before the leader is here.
    void await_leader() const {
        if (options_.team != nullptr)
            options_.team->from_leader(0);
    }

    /// Lets a render keep what it has beside the image that it is to become.
    void keep_as(RenderOptions& render, const std::filesystem::path& image) const {
        std::filesystem::create_directories(image.parent_path());
        render.checkpoint = checkpoint_of(image);
        render.resume = true;
        render.restart_if_other = !options_.resume;
    }

    static std::filesystem::path checkpoint_of(const std::filesystem::path& image) {
        return image.string() + ".checkpoint";
    }

    /// Once the image is kept.
    static void remove_checkpoint(const std::filesystem::path& image) {
        std::error_code ignored;
        std::filesystem::remove(checkpoint_of(image), ignored);
    }

    /// Renders with progress from `share` on; sets `interrupted` when it was stopped.
    RenderResult render_until(const RenderOptions& render, double share, double share_of_all,
                              const std::string& name, const RenderObserver& observe,
                              Team* team = nullptr) {
        const auto progress = [&](const RenderProgress& state) {
            const double done = std::max(state.seconds / render.time_seconds,
                                         static_cast<double>(state.samples) / render.samples);
            const bool goes_on = progress_(
                share + share_of_all * std::min(1.0, done),
                fmt::format("{}: {} spp, relMSE {:.2g}", name, state.samples, state.relmse));
            result_.interrupted = !goes_on;
            return goes_on;
        };
        return team != nullptr ? render_together(scene_, device_, render, *team, progress, observe)
                               : reradiant::render(scene_, device_, render, progress, observe);
    }

    /// Methods are measured by members and kept in the folder, where the leader reads them.
    void share_methods(Team& team) {
        const std::size_t count = options_.methods.size();
        std::size_t next = 0;
        bool interrupted = false;
        team.share_tasks(
            [&](const TeamReport& report) -> TeamTask {
                interrupted |= report.interrupted;
                return interrupted || next == count ? TeamTask{} : TeamTask{next++, 1};
            },
            [&](const TeamTask& task) -> TeamReport {
                add_method(task.first);
                return {task, 0.0, result_.interrupted};
            },
            team.rank_on_host() == 0);
        result_.interrupted = team.from_leader(interrupted) != 0;
        std::string measured_now(count, '-');
        for (const MethodResult& method : result_.methods)
            for (std::size_t k = 0; k < count; ++k)
                if (!method.resumed && method.curve.method.name == options_.methods[k].name)
                    measured_now[k] = '+';
        const std::vector<std::string> told = team.gather(measured_now);
        if (team.leads())
            collect_methods(told);
    }

    void collect_methods(const std::vector<std::string>& measured_now) {
        result_.methods.clear();
        for (std::size_t k = 0; k < options_.methods.size(); ++k)
            if (take_kept(k))
                result_.methods.back().resumed =
                    std::none_of(measured_now.begin(), measured_now.end(),
                                 [&](const std::string& one) { return one[k] == '+'; });
            else if (!result_.interrupted)
                refuse_folder("the method " + options_.methods[k].name);
    }

    std::string method_identity(std::size_t index) const {
        return sha256_of(fmt::format("{} {} {} {} {}", common_identity(scene_, device_, options_),
                                     result_.reference.identity, result_.seed,
                                     options_.time_seconds, options_.methods[index].name));
    }

    bool take_kept(std::size_t index) {
        auto kept = kept_method(options_.folder, method_identity(index), options_.methods[index]);
        if (!kept || !is_of_film(kept->image, scene_, bands()))
            return false;
        result_.methods.push_back(std::move(*kept));
        return true;
    }

    void add_method(std::size_t index) {
        if (take_kept(index))
            return;
        const double all = options_.reference.empty() ? 1.0 - share_of_reference(options_) : 1.0;
        const double share = all / static_cast<double>(options_.methods.size());
        MethodResult result =
            measured(index, 1.0 - all + share * static_cast<double>(index), share);
        if (result_.interrupted)
            return;
        keep_method(options_.folder, method_identity(index), result);
        remove_checkpoint(method_image(options_.folder, options_.methods[index]));
        result_.methods.push_back(std::move(result));
    }

    MethodResult measured(std::size_t index, double share, double share_of_all) {
        const RenderMethod& method = options_.methods[index];
        MethodResult result;
        result.curve.method = method;
        std::vector<CurveRow>& rows = result.curve.rows;
        std::vector<CurveRow> earlier = kept_rows(options_.folder, method_identity(index), method);
        bool begun = false;
        const auto observe = [&](const RenderProgress& state, const auto& image) {
            if (!begun) // those before the checkpoint that the render goes on from
                std::copy_if(earlier.begin(), earlier.end(), std::back_inserter(rows),
                             [&](const CurveRow& row) {
                                 return row.seconds < state.seconds && row.samples < state.samples;
                             });
            begun = true;
            const double next_seconds = rows.empty() ? 0.0 : time_ratio * rows.back().seconds;
            if (state.seconds < std::min(next_seconds, options_.time_seconds))
                return;
            rows.push_back({state.seconds,
                            0.0,
                            state.samples,
                            compare_images(image(), result_.reference.image),
                            {state.relmse, state.relmse_low, state.relmse_high}});
            keep_rows(options_.folder, method_identity(index), result.curve);
        };
        RenderOptions render = method_options(options_, method, result_.seed);
        const double setup_and_pass = warm_up(render, result.curve);
        keep_as(render, method_image(options_.folder, method));
        RenderResult rendered = render_until(render, share, share_of_all, method.name, observe);
        result.curve.setup_seconds =
            std::max(0.0, setup_and_pass - rendered.passes.front().seconds);
        for (CurveRow& row : rows)
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

double reference_seconds(const ConvergeOptions& options) {
    constexpr double times_a_method = 10.0;
    return times_a_method * options.time_seconds;
}

ConvergeResult converge(const Scene& scene, const Device& device, const ConvergeOptions& options,
                        const StudyProgress& progress) {
    check_methods(scene, options);
    return Run(scene, device, options, progress).result();
}

} // namespace reradiant
