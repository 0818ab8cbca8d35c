#pragma once

#include "host/scene/scene.h"
#include "kernels/shared.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace reradiant {

/// The scene's surfaces (shapes, and the lights that have a surface) behind Embree.
/// All functions may be called from any thread.
class Geometry {
public:
    /// Throws an input Error that names shape and primitive for NaN, Inf, coordinates beyond
    /// 1e18, indices out of range and degenerate sizes (CASES 6, 7). Without `wants_parameters`
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
    /// The same for the rays whose places are in `live`, each once; the others are not touched.
    void intersect(std::span<const RayRecord> rays, std::span<HitRecord> hits,
                   std::span<const std::uint32_t> live, bool coherent, int threads) const;
    /// `occlude` counts the rays that were active.
    std::uint64_t occlude(std::span<RayRecord> rays, std::span<const std::uint32_t> live,
                          int threads) const;

    std::size_t triangle_count() const;
    std::size_t memory_bytes() const; ///< what Embree reports
    const char* library_version() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace reradiant
