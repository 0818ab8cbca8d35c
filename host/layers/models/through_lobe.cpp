#include "host/layers/models/through_lobe.h"

#include "host/layers/walk/walk_surface.h"
#include "kernels/scatter/through_shape.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <vector>

namespace reradiant {

using kernels::Vec3;

namespace {

/// Walks from every node of cosine.
constexpr unsigned walks = 4096;
/// No more than this much light is put where the lobe itself has next to none.
constexpr double largest_ratio = 64.0;

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

double rounded_ior(double ior) {
    const double step = std::fabs(ior - 1.0) < 0.1 ? 0.01 : 0.05;
    return std::round(ior / step) * step;
}

/// A width or a depth rounded to a 16th part of an octave.
double rounded_size(double size) {
    return size > 0.0 ? std::exp2(std::round(std::log2(size) * 16.0) / 16.0) : 0.0;
}

/// A sheet nearby that stands for all of its neighbourhood. Films are left out.
ThroughSheet rounded(const ThroughSheet& sheet) {
    ThroughSheet nearby = sheet;
    for (double& depth : nearby.depths)
        depth = depth > 1e-3 ? rounded_size(depth) : 0.0;
    for (SurfaceValues& surface : nearby.surfaces) {
        if (surface.scatters())
            surface.alpha = std::min(rounded_size(surface.alpha), 1.0);
        surface.ior_above = rounded_ior(surface.ior_above);
        surface.ior_below = rounded_ior(surface.ior_below);
        surface.film = {};
        surface.wavelength_nm = 0.0;
    }
    for (std::size_t k = 0; k < sheet.surfaces.size(); ++k)
        if (sheet.surfaces[k].scatters() != nearby.surfaces[k].scatters())
            return sheet; // two media as near to each other as that
    return nearby;
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

    /// Adds to the sums what light from v, in the frame of the first surface, brings to the
    /// targets, which lie beyond the last one.
    void add(Vec3 v, WalkRandom& random, std::span<SurfaceTarget> targets,
             std::span<double> sums) const {
        constexpr double least_weight = 1e-4;
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

Vec3 direction_at_node(std::size_t node) {
    const double c = kernels::through_shape_node_cosine(static_cast<kernels::uint>(node));
    return kernels::vec3(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
}

/// The direction whose half vector with `own` lies at a node of slope and of azimuth.
Vec3 direction_at_node(const Vec3& own, double width, std::size_t slope, std::size_t azimuth) {
    const double x = static_cast<double>(slope) / (THROUGH_SLOPES - 1);
    const double most = kernels::through_shape_largest(own.z);
    const double m = width * std::expm1(x * std::log1p(most / width));
    const double phi = std::numbers::pi * static_cast<double>(azimuth) / (THROUGH_AZIMUTHS - 1);
    const Vec3 h =
        kernels::vec3_normalise(kernels::vec3(m * std::cos(phi), m * std::sin(phi), 1.0));
    return kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * kernels::vec3_dot(own, h)), own);
}

/// What light from one node of cosine is asked for: nodes of slope and azimuth whose directions lie
/// above the horizon.
struct Targets {
    std::vector<SurfaceTarget> directions;
    std::vector<double> lobes;
    std::vector<std::size_t> nodes; ///< in the table's part for the cosine

    Targets(const LobeShape& lobe, const Vec3& own) {
        const double width = sampling_width(lobe, own.z);
        for (std::size_t node = 0; node < THROUGH_SLOPES * THROUGH_AZIMUTHS; ++node) {
            const Vec3 w =
                direction_at_node(own, width, node / THROUGH_AZIMUTHS, node % THROUGH_AZIMUTHS);
            if (!(w.z > least_cosine))
                continue;
            // w is a mirror image, and the frame below has all axes turned over
            directions.push_back({false, kernels::vec3(-w.x, -w.y, w.z)});
            lobes.push_back(lobe_value(lobe, own, w));
            nodes.push_back(node);
        }
    }

private:
    static constexpr double least_cosine = 1e-3;
};

/// Ratios of light from one node of cosine: [slope][azimuth]. Beneath the horizon a slope takes the
/// ratio of the next smaller one.
std::vector<double> ratios_from(const SheetWalk& walk, const LobeShape& lobe, std::size_t node) {
    const Vec3 own = direction_at_node(node);
    Targets targets(lobe, own);
    std::vector<double> sums(targets.nodes.size());
    for (unsigned k = 0; k < walks; ++k) {
        WalkRandom random(0, k, node);
        walk.add(own, random, targets.directions, sums);
    }
    std::vector<double> ratios(THROUGH_SLOPES * THROUGH_AZIMUTHS, -1.0);
    for (std::size_t t = 0; t < sums.size(); ++t) {
        const double value = sums[t] / walks;
        ratios[targets.nodes[t]] =
            value < largest_ratio * targets.lobes[t] ? value / targets.lobes[t] : largest_ratio;
    }
    for (std::size_t t = 0; t < ratios.size(); ++t)
        if (ratios[t] < 0.0)
            ratios[t] = t >= THROUGH_AZIMUTHS ? ratios[t - THROUGH_AZIMUTHS] : 0.0;
    return ratios;
}

/// A table, and whether its directions of cosine lie below the sheet.
struct ThroughTable {
    std::shared_ptr<const std::vector<float>> ratios;
    bool from_below = false;
};

ThroughTable compute_table(const ThroughSheet& sheet) {
    ThroughSheet seen = sheet;
    const bool from_below = seen.surfaces.front().alpha > seen.surfaces.back().alpha;
    const LobeShape lobe = plain_lobe(sheet.surfaces);
    if (from_below) {
        std::reverse(seen.surfaces.begin(), seen.surfaces.end());
        std::reverse(seen.depths.begin(), seen.depths.end());
    }
    const SheetWalk walk(seen, from_below);
    std::vector<float> table(THROUGH_TABLE_SIZE);
    // isolated: a caller's own parallel loop must not be entered here, while the store is locked
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, THROUGH_COSINES, 1), [&](const auto& range) {
                for (std::size_t i = range.begin(); i != range.end(); ++i)
                    std::ranges::copy(ratios_from(walk, lobe, i),
                                      table.begin() + static_cast<std::ptrdiff_t>(
                                                          i * THROUGH_SLOPES * THROUGH_AZIMUTHS));
            });
    });
    return {std::make_shared<const std::vector<float>>(std::move(table)), from_below};
}

ThroughTable table_of(const ThroughSheet& sheet) {
    std::vector<double> key = sheet.depths;
    for (const SurfaceValues& surface : sheet.surfaces)
        key.insert(key.end(), {surface.ior_above, surface.ior_below, surface.alpha,
                               static_cast<double>(surface.distribution),
                               static_cast<double>(surface.scattering)});
    static std::mutex mutex;
    static std::map<std::vector<double>, ThroughTable> known;
    const std::scoped_lock lock(mutex);
    ThroughTable& table = known[key];
    if (!table.ratios)
        table = compute_table(sheet);
    return table;
}

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
    const ThroughTable table = table_of(rounded(sheet));
    ThroughLobe lobe{plain_lobe(sheet.surfaces), {}};
    lobe.above.table = table.ratios;
    lobe.below = lobe.above;
    (table.from_below ? lobe.below : lobe.above).through = LobeShape::Through::First;
    (table.from_below ? lobe.above : lobe.below).through = LobeShape::Through::Second;
    return std::make_shared<const ThroughLobe>(std::move(lobe));
}

} // namespace reradiant
