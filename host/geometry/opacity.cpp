#include "host/geometry/opacity.h"

#include "host/scene/model/texture_record.h"
#include "kernels/scene/texture.h"

#include <algorithm>
#include <bit>
#include <map>

namespace reradiant {

namespace {

/// A number in [0, 1) that depends on where a ray starts, where it goes and what it meets.
double number_of(const RayRecord& ray, const HitRecord& hit) {
    std::uint32_t word = hit.shape;
    for (const float part : {ray.origin_x, ray.origin_y, ray.origin_z, ray.direction_x,
                             ray.direction_y, ray.direction_z, hit.distance})
        word = kernels::random_hash(word ^ std::bit_cast<std::uint32_t>(part), 0x0bac17u);
    return kernels::random_unit(word);
}

} // namespace

Opacity::Opacity(const Scene& scene) {
    if (std::ranges::all_of(scene.surfaces, &Surface::is_opaque))
        return;
    std::map<int, std::uint32_t> offsets; // of images
    for (const Surface& surface : scene.surfaces) {
        Share share{surface.opacity, surface.opacity_texture >= 0, {}};
        if (share.is_textured) {
            const Texture& texture =
                scene.textures[static_cast<std::size_t>(surface.opacity_texture)];
            share.texture = texture_record(texture);
            if (texture.image >= 0) {
                const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
                const auto [place, is_new] =
                    offsets.try_emplace(texture.image, static_cast<std::uint32_t>(texels_.size()));
                if (is_new)
                    texels_.insert(texels_.end(), image.rgb.begin(), image.rgb.end());
                set_image(image, place->second, share.texture);
            }
        }
        surfaces_.push_back(share);
    }
}

bool Opacity::stops(const RayRecord& ray, const HitRecord& hit) const {
    if (hit.light != NO_INDEX || hit.material == NO_INDEX)
        return true;
    const Share& share = surfaces_[hit.material];
    double opacity = share.ends[0];
    if (share.is_textured) {
        const auto place = kernels::vec3(hit.position_x, hit.position_y, hit.position_z);
        const double t =
            kernels::texture_at(share.texture, place, hit.u, hit.v, texels_.data()).value;
        opacity += t * (share.ends[1] - share.ends[0]);
    }
    return opacity >= 1.0 || number_of(ray, hit) < opacity;
}

} // namespace reradiant
