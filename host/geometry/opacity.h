#pragma once

#include "kernels/core/shared.h"
#include "reradiant/scene.h"

#include <array>
#include <vector>

namespace reradiant {

/// Which hits on surfaces with an opacity below 1 stop a ray. The others let it through as if there
/// were no surface, so that neither the kernels nor the sampling of lights know of it.
class Opacity {
public:
    explicit Opacity(const Scene& scene);

    bool is_empty() const { return surfaces_.empty(); }
    /// Draws from the numbers of the ray and of the hit, so that the same ray meets the same
    /// surface whatever is traced beside it.
    bool stops(const RayRecord& ray, const HitRecord& hit) const;

private:
    struct Share {
        std::array<double, 2> ends{1.0, 1.0}; ///< at 0 and 1 of the texture
        bool is_textured = false;
        TextureRecord texture{};
    };
    std::vector<Share> surfaces_; ///< as in Scene::surfaces; empty: all are opaque
    std::vector<float> texels_;
};

} // namespace reradiant
