#pragma once

#include "kernels/core/shared.h"
#include "reradiant/scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace reradiant {

/// Rays whose nearest hits are wanted.
struct RaysToHit {
    std::span<const RayRecord> rays;
    std::span<HitRecord> hits;
    std::span<const std::uint32_t> live; ///< places of those that count
    bool coherent = false;
};

/// Smooth sheets that rays pass straight on, where there are any.
struct PassedSheets {
    std::span<const std::uint32_t> materials; ///< by surface: the sheet's material, or NO_INDEX
    std::span<SheetCrossing> crossings;       ///< MOST_CROSSINGS for each ray, to be filled
    unsigned most = 0;                        ///< sheets that a ray may pass here
};

/// Rays that something may block.
struct RaysToBlock {
    std::span<RayRecord> rays;
    std::span<const std::uint32_t> live;
    PassedSheets sheets{};
};

struct TraceStatistics {
    double hit_seconds = 0.0, block_seconds = 0.0; ///< summed over all threads
    std::uint64_t blockable = 0;                   ///< rays of RaysToBlock that were active
};

/// The scene's surfaces (shapes, and the lights that have a surface) behind Embree.
/// All functions may be called from any thread.
class Geometry {
public:
    /// Throws an input Error that names shape and primitive for NaN, Inf, coordinates beyond
    /// 1e18, indices out of range and degenerate sizes. Without `wants_parameters`
    /// hits on shapes that are no meshes have u = v = 0.
    explicit Geometry(const Scene& scene, bool wants_parameters = true);
    ~Geometry();
    Geometry(const Geometry&) = delete;
    Geometry& operator=(const Geometry&) = delete;

    /// Nearest hits for a batch, in parallel on `threads` threads (0: all). Inactive rays
    /// (t_far < 0) and rays with a non-finite or zero direction get shape = NO_INDEX.
    /// `coherent` says that neighbours in the batch point nearly the same way (camera rays).
    void intersect(std::span<const RayRecord> rays, std::span<HitRecord> hits, bool coherent,
                   int threads) const;
    /// Sets t_far = -1 for every ray that something blocks in (t_near, t_far).
    void occlude(std::span<RayRecord> rays, int threads) const;
    /// Traces both in one go, for the rays whose places are listed, each once; others are not
    /// touched.
    TraceStatistics trace(const RaysToHit& rays, const RaysToBlock& shadow_rays, int threads) const;

    std::size_t triangle_count() const;
    std::size_t memory_bytes() const; ///< as Embree reports it
    const char* library_version() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace reradiant
