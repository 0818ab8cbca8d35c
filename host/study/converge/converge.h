#pragma once

#include "host/base/team.h"
#include "host/study/converge/error_curve.h"
#include "reradiant/device.h"
#include "reradiant/render.h"
#include "reradiant/scene.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace reradiant {

struct ConvergeOptions {
    std::filesystem::path folder; ///< for results, and for what an interrupted run goes on from
    std::vector<RenderMethod> methods;
    std::filesystem::path reference;     ///< empty: it is rendered, with other random numbers
    std::uint32_t reference_samples = 0; ///< 0: for ten times the time of a method
    double time_seconds = 10.0;          ///< that each method renders for
    RenderOptions render; ///< seed, threads, bands, memory and seconds between checkpoints are used
    bool resume = false;  ///< refuse a checkpoint that is of another render; else begin it anew
    /// Renders the reference together; methods are timed one at a time on every machine, by its
    /// first member while the others rest. Members share the folder.
    Team* team = nullptr;
};

/// A `Reference` is the image that errors are measured against.
struct Reference {
    SpectralImage image;
    std::filesystem::path file;
    std::string identity;    ///< changes with everything that the image depends on
    RelmseEstimate estimate; ///< of its own error; infinite when the file does not say
};

struct MethodResult {
    ErrorCurve curve;
    SpectralImage image; ///< at the end of the method's time
    bool resumed = false;
};

struct ConvergeResult {
    Reference reference;
    std::uint32_t seed = 0; ///< the methods'; the reference has another
    std::vector<MethodResult> methods;
    bool interrupted = false; ///< methods that were finished are there
};

/// Share done, 0 to 1, and a note; returning false stops.
using StudyProgress = std::function<bool(double share, const std::string& note)>;

/// Seconds that a reference without a count of samples is rendered for.
double reference_seconds(const ConvergeOptions& options);

/// Renders a scene by every method, and compares with the reference at geometric steps of time.
/// Finished methods are kept in `folder` and not rendered again there by a run with the same
/// scene, seed, reference and time; one that was interrupted goes on from its checkpoint. Input
/// Error for a method that the scene cannot be rendered by, and for a reference of another size or
/// other bands, before anything is rendered.
ConvergeResult converge(const Scene& scene, const Device& device, const ConvergeOptions& options,
                        const StudyProgress& progress);

} // namespace reradiant
