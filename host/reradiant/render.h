#pragma once

#include "reradiant/device.h"
#include "reradiant/scene.h"
#include "reradiant/spectral_image.h"
#include "reradiant/wavelength_plan.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

struct RenderHooks; // host/render/wavefront/render_hooks.h

struct RenderOptions {
    std::uint32_t samples = 64;     ///< per pixel; stops at the first of samples, time and error
    std::uint32_t first_sample = 0; ///< for partial renders of disjoint ranges
    double time_seconds = std::numeric_limits<double>::infinity();
    double relmse = 0.0; ///< stop when the estimate is at most this
    std::uint32_t seed = 0;
    int threads = 0;
    Model model = Model::Auto;           ///< other than Auto: instead of every material's own
    std::optional<WavelengthGrid> bands; ///< instead of the scene's
    WavelengthOptions wavelengths;
    bool band_variance = false;
    bool adaptive = false; ///< more samples where the error is (host/render/wavefront/adaptive.h);
                           ///< `samples` is then the mean over pixels
    /// What each group of lights adds is kept apart (RenderResult::light_layers): lights of one
    /// name (Scene::light_groups), and every other light by itself. The image is the same.
    bool light_groups = false;
    bool all_features = false;
    std::string also_on;    ///< one feature (RenderFeatures) that kernels get, needed or not
    bool in_double = false; ///< kernels compute in double what they do not keep, for comparison
    std::size_t batch_paths = 1u << 15;
    std::uint64_t memory_limit_bytes = 0; ///< 0: 80 % of the machine's memory
    int processes_on_machine = 1;     ///< processes that share the memory when no limit is given
    std::filesystem::path checkpoint; ///< empty: none is written or read
    double checkpoint_seconds = 60.0; ///< at most so long between two of them
    bool resume = false;              ///< go on from `checkpoint` where it exists
    bool restart_if_other = false; ///< ... and fits; else warn and begin anew, instead of refusing
    const RenderHooks* hooks = nullptr; ///< called on the way; null: there are none
};

/// The state of a render after one pass.
struct RenderProgress {
    std::uint32_t samples = 0;
    double seconds = 0.0; ///< since rendering began, set-up not counted
    double relmse = std::numeric_limits<double>::infinity(); ///< estimated
    /// 95 % interval of the error that the image has (host/render/film/error_estimate.h).
    double relmse_low = 0.0, relmse_high = std::numeric_limits<double>::infinity();
};

/// Sees what a render has after a pass. `image` resolves the mean so far, during the call alone.
using RenderObserver =
    std::function<void(const RenderProgress& state, const std::function<SpectralImage()>& image)>;

struct RenderResult {
    SpectralImage image;
    std::vector<LightLayer> light_layers; ///< that add up to the image, where they are asked for
    std::vector<RenderProgress> passes;
    double setup_seconds = 0.0, build_seconds = 0.0;
    double trace_seconds = 0.0; ///< rays on the host
    double shade_seconds = 0.0; ///< all kernels
    std::map<std::string, double> stage_seconds;
    double total_seconds = 0.0;
    std::uint32_t samples = 0;
    std::uint32_t resumed_samples = 0; ///< those of `samples` that came from a checkpoint
    bool interrupted = false;          ///< `progress` said stop; a checkpoint holds what was done
    std::uint64_t paths = 0, rays = 0, non_finite = 0;
    double relmse = std::numeric_limits<double>::infinity();
    BuildStatistics build;
    WavelengthPlan plan;
    std::map<std::string, bool> features;
    std::vector<std::string> left_out, notes;
    std::size_t device_bytes = 0, table_bytes = 0;
    std::uint64_t mapped_bytes = 0; ///< rays and hits that went between device and host
};

/// Renders a scene. `progress` is called after every pass; returning false stops the render, and
/// the result holds what was done. `observe` is called before it; the time that it takes is left
/// out of RenderProgress::seconds. Input Error when the predicted memory exceeds the limit, or when
/// the checkpoint to resume is damaged or of another scene, build, device or setting. The
/// checkpoint stays until the image is kept; one that cannot be written costs a warning.
RenderResult render(const Scene& scene, const Device& device, const RenderOptions& options,
                    const std::function<bool(const RenderProgress&)>& progress = {},
                    const RenderObserver& observe = {});

/// Bytes that rendering will take for film, paths and result (before anything is allocated).
std::uint64_t predicted_render_bytes(const Scene& scene, const WavelengthPlan& plan,
                                     const RenderOptions& options);

} // namespace reradiant
