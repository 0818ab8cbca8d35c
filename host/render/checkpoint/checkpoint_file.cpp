#include "host/render/checkpoint/checkpoint_file.h"

#include "host/base/logging.h"
#include "host/render/checkpoint/render_identity.h"
#include "reradiant/error.h"

#include <algorithm>
#include <span>

namespace reradiant {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void restore(std::span<const DeviceFilm> films, const RenderCheckpoint& kept) {
    const std::size_t sums = kept.sums.size() / films.size(),
                      statistics = kept.statistics.size() / films.size();
    for (std::size_t k = 0; k < films.size(); ++k)
        films[k].restore(std::span(kept.sums).subspan(k * sums, sums),
                         std::span(kept.statistics).subspan(k * statistics, statistics));
}

} // namespace

CheckpointFile::CheckpointFile(const Scene& scene, const Device& device,
                               const RenderOptions& options)
    : options_(options) {
    if (!options.checkpoint.empty())
        head_.identity = render_identity(scene, device, options);
}

RenderProgress CheckpointFile::resume(Wavefront& wavefront, RenderResult& result) const {
    std::error_code ignored;
    if (options_.checkpoint.empty() || !options_.resume ||
        !std::filesystem::exists(options_.checkpoint, ignored))
        return {};
    RenderCheckpoint kept;
    try {
        kept = read_checkpoint(options_.checkpoint, head_.identity,
                               wavefront.films().size() * wavefront.film().float_count());
    } catch (const Error& error) {
        if (!options_.restart_if_other)
            throw;
        logging::warn("{}; this render begins anew", error.what());
        return {};
    }
    restore(wavefront.films(), kept);
    result.passes = kept.passes;
    result.paths = kept.paths;
    result.rays = kept.rays;
    result.resumed_samples = kept.passes.back().samples;
    return kept.passes.back();
}

void CheckpointFile::after_pass(const Wavefront& wavefront, const RenderResult& result) {
    if (options_.checkpoint.empty() ||
        (!result.interrupted &&
         seconds_since(written_) < std::max(options_.checkpoint_seconds, 10.0 * write_seconds_)))
        return;
    const Clock::time_point start = Clock::now();
    head_.passes = result.passes;
    head_.paths = result.paths + wavefront.statistics().paths;
    head_.rays = result.rays + wavefront.statistics().rays;
    try {
        read_films(wavefront.films(),
                   [&](FilmSums films) { write_checkpoint(options_.checkpoint, head_, films); });
    } catch (const Error& error) {
        // A full disk costs the checkpoint, not the render; an interrupted one has no more.
        if (result.interrupted)
            throw;
        logging::warn("{}; the render goes on without", error.what());
    }
    written_ = Clock::now();
    write_seconds_ = seconds_since(start);
}

} // namespace reradiant
