#include "host/render/wavefront/team_render.h"

#include "host/render/checkpoint/render_identity.h"
#include "host/render/film/team_film.h"
#include "host/render/wavefront/render_run.h"
#include "host/render/wavefront/sample_dispenser.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

namespace reradiant {

namespace {

/// Devices may differ; samples are added all the same.
void check_same_render(const Scene& scene, const Device& device, const RenderOptions& options,
                       Team& team) {
    SampleIdentity identity = render_identity(scene, device, options);
    identity.pop_back(); // the device
    const std::string mine = identity_text(identity);
    const std::vector<std::string> all = team.gather(mine);
    for (std::size_t rank = 1; rank < all.size(); ++rank)
        if (all[rank] != mine)
            throw_input_error({scene.file.string()},
                              fmt::format("rank {} has another scene, other options or another "
                                          "build of the program than rank 0",
                                          rank),
                              "give every machine the same files and program");
}

/// Seconds until the films come together again: for the next checkpoint, or because somebody wants
/// to know the error or see the picture, more and more rarely as it changes less and less.
double round_seconds(const RenderOptions& options, double seconds_so_far, bool is_watched) {
    double seconds = options.checkpoint.empty() ? std::numeric_limits<double>::infinity()
                                                : options.checkpoint_seconds;
    if (is_watched)
        seconds = std::min(seconds, std::max(1.0, seconds_so_far / 4.0));
    return seconds;
}

/// Renders what the leader hands out until the round is over.
void render_round(RenderRun& rendering, const RenderOptions& options, Team& team,
                  SampleDispenser& dispenser,
                  const std::function<bool(const RenderProgress&)>& progress) {
    RenderProgress shown = rendering.state();
    const auto work = [&](const TeamTask& task) -> TeamReport {
        const double start = rendering.seconds();
        const auto first = static_cast<std::uint32_t>(task.first);
        rendering.wavefront().render_pass(options.first_sample + first,
                                          static_cast<std::uint32_t>(task.count));
        shown.seconds = rendering.seconds();
        shown.samples = dispenser.handed_out();
        return {task, shown.seconds - start, progress && !progress(shown)};
    };
    team.share_tasks([&](const TeamReport& report) { return dispenser.next(report); }, work);
}

/// Paths and rays of all members, at the leader.
void add_counts(RenderResult& result, Team& team) {
    std::array<double, 2> counts{static_cast<double>(result.paths),
                                 static_cast<double>(result.rays)};
    team.add_at_leader(counts);
    result.paths = static_cast<std::uint64_t>(counts[0]);
    result.rays = static_cast<std::uint64_t>(counts[1]);
}

} // namespace

RenderResult render_together(const Scene& scene, const Device& device, const RenderOptions& options,
                             Team& team, const std::function<bool(const RenderProgress&)>& progress,
                             const RenderObserver& observe) {
    if (options.adaptive)
        throw_input_error({},
                          "--adaptive decides after every pass which samples to take, which "
                          "machines that share a render cannot",
                          "leave --adaptive away, or render by one process");
    check_same_render(scene, device, options, team);
    RenderRun rendering(scene, device, options);
    if (team.leads())
        rendering.resume();
    SampleDispenser dispenser(options, rendering.state(), team.size());
    const bool is_watched = options.relmse > 0.0 || observe;
    while (team.from_leader(!rendering.must_stop() && !dispenser.interrupted()) != 0) {
        const double before = rendering.seconds();
        dispenser.begin_round(round_seconds(options, before, is_watched),
                              rendering.counted_seconds());
        render_round(rendering, options, team, dispenser, progress);
        for (DeviceFilm& film : rendering.wavefront().films())
            add_films(film, rendering.plan().film, team);
        if (team.leads())
            rendering.after_pass(dispenser.handed_out(), observe,
                                 [&](const RenderProgress&) { return !dispenser.interrupted(); });
    }
    RenderResult result = team.leads() ? rendering.finish_with_image() : rendering.finish();
    add_counts(result, team);
    return result;
}

} // namespace reradiant
