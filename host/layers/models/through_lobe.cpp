#include "host/layers/models/through_lobe.h"

#include "host/layers/models/lobe_ratios.h"
#include "host/layers/walk/walk_surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace reradiant {

using kernels::Vec3;

namespace {

/// A sheet's surfaces from above, and the depths of absorption of the slabs between them.
struct ThroughSheet {
    std::vector<SurfaceValues> surfaces;
    std::vector<double> depths;

    ThroughSheet(std::span<const StackElement> sheet) {
        for (const StackElement& element : sheet) {
            if (const auto* surface = std::get_if<SurfaceValues>(&element))
                surfaces.push_back(*surface);
            else if (const auto* slab = std::get_if<SlabValues>(&element))
                depths.push_back(slab->tau);
        }
    }
};

/// The lobe of ggx facets, whose tails are long enough for all, by half a passage through every
/// rough face on the way in and half of it on the way out.
LobeShape plain_lobe(std::span<const SurfaceValues> surfaces) {
    LobeShape lobe;
    const double half = std::pow(0.5, 1.0 / 1.5); // lobe_width_term
    for (const SurfaceValues& surface : surfaces)
        if (surface.scatters())
            lobe.passages.push_back({half * surface.alpha, surface.ior_above, surface.ior_below});
    lobe.ior = 1.0; // no facet of its own: alpha is 0
    return lobe;
}

ThroughSheet turned_over(ThroughSheet sheet) {
    std::ranges::reverse(sheet.surfaces);
    std::ranges::reverse(sheet.depths);
    return sheet;
}

/// A sheet nearby that stands for all of its neighbourhood.
ThroughSheet nearby(ThroughSheet sheet) {
    for (double& depth : sheet.depths)
        depth = depth > 1e-3 ? rounded_size(depth) : 0.0;
    for (SurfaceValues& surface : sheet.surfaces)
        surface = rounded(surface);
    return sheet;
}

std::vector<double> key_of(const ThroughSheet& sheet) {
    std::vector<double> key{0.0}; // a lobe through a sheet
    key.insert(key.end(), sheet.depths.begin(), sheet.depths.end());
    for (const SurfaceValues& surface : sheet.surfaces)
        append_key(surface, key);
    return key;
}

/// The way of light through a sheet from one side to the facets of its last surface.
class SheetWalk {
public:
    /// `sheet` from the side that light comes from; its last surface is rough.
    SheetWalk(const ThroughSheet& sheet, bool from_below)
        : depths_(sheet.depths), from_below_(from_below) {
        for (const SurfaceValues& surface : sheet.surfaces)
            surfaces_.push_back(walk_surface(surface));
    }

    /// Adds what light from `own` brings to the targets, which lie beyond the last surface.
    void add(const Vec3& own, std::span<SurfaceTarget> targets, WalkRandom& random,
             std::span<double> sums) const {
        constexpr double least_weight = 1e-4;
        Vec3 v = own;
        double weight = 1.0;
        bool backwards = false; // it goes to where it came from
        for (std::size_t k = 0; weight > least_weight;) {
            const bool is_last = k + 1 == surfaces_.size(), leaves = is_last && !backwards;
            for (SurfaceTarget& target : targets)
                target.value = 0.0;
            const SurfaceEvent next = meet(surfaces_[k], backwards, v,
                                           leaves ? targets : std::span<SurfaceTarget>(), random);
            for (std::size_t t = 0; leaves && t < targets.size(); ++t)
                sums[t] += weight * targets[t].value;
            backwards = next.same_side != backwards;
            if (backwards ? k == 0 : is_last)
                return;
            v = next.w;
            k = backwards ? k - 1 : k + 1;
            // a slab stands behind its surface
            weight *= next.weight * std::exp(-depths_[backwards ? k : k - 1] / v.z);
        }
    }

private:
    SurfaceEvent meet(const WalkSurface& surface, bool backwards, const Vec3& v,
                      std::span<SurfaceTarget> targets, WalkRandom& random) const {
        const bool from_below = backwards != from_below_;
        return surface.is_rough() ? meet_rough_surface(surface, from_below, v, targets, random)
                                  : meet_smooth_surface(surface, from_below, v, random);
    }

    std::vector<WalkSurface> surfaces_;
    std::vector<double> depths_;
    bool from_below_;
};

/// Depth of absorption on the way down.
double depth_of(std::span<const StackElement> sheet) {
    double depth = 0.0;
    for (const StackElement& element : sheet)
        if (const auto* slab = std::get_if<SlabValues>(&element))
            depth += slab->tau;
    return depth;
}

} // namespace

std::shared_ptr<const ThroughLobe> through_lobe(std::span<const StackElements> bands) {
    const StackElements& clearest = *std::ranges::min_element(bands, {}, depth_of);
    const ThroughSheet sheet(clearest);
    if (std::none_of(sheet.surfaces.begin(), sheet.surfaces.end(),
                     [](const SurfaceValues& surface) { return surface.scatters(); }))
        return nullptr;
    const ThroughSheet rounded_sheet = nearby(sheet);
    const bool from_below = sheet.surfaces.front().alpha > sheet.surfaces.back().alpha;
    ThroughLobe lobe{plain_lobe(sheet.surfaces), {}};
    const SheetWalk walk(from_below ? turned_over(rounded_sheet) : rounded_sheet, from_below);
    const auto aimed = [&](const Vec3& own, std::span<const Vec3> others) -> LobeWalk {
        std::vector<SurfaceTarget> targets;
        for (const Vec3& w : others) // mirror images, and the frame beyond has all axes turned over
            targets.push_back({false, kernels::vec3(-w.x, -w.y, w.z)});
        return [&walk, own, targets](WalkRandom& random, std::span<double> sums) mutable {
            walk.add(own, targets, random, sums);
        };
    };
    lobe.above.table =
        lobe_ratios(plain_lobe(rounded_sheet.surfaces), aimed, key_of(rounded_sheet));
    lobe.below = lobe.above;
    (from_below ? lobe.below : lobe.above).table_kind = LobeShape::Table::OwnFirst;
    (from_below ? lobe.above : lobe.below).table_kind = LobeShape::Table::OwnSecond;
    return std::make_shared<const ThroughLobe>(std::move(lobe));
}

} // namespace reradiant
