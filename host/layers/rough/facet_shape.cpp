#include "host/layers/rough/facet_shape.h"

#include "host/layers/rough/interface_file.h"
#include "kernels/scatter/facet_shape.h"
#include "kernels/walk/walk_microsurface.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

namespace reradiant {

using kernels::Vec3;

namespace {

constexpr std::size_t cosines = SHAPE_COSINES, slopes = SHAPE_PLACES;
/// Generator as in L'Ecuyer and Lemieux 2000, table 1.
constexpr LatticeRule walk_rule{8191, 5130};

double node_cosine(std::size_t node) {
    return kernels::facet_shape_node_cosine(static_cast<kernels::uint>(node));
}

double sine(double cosine) {
    return std::sqrt((1.0 - cosine) * (1.0 + cosine));
}

Vec3 node_direction(std::size_t node) {
    const double c = node_cosine(node);
    return kernels::vec3(sine(c), 0.0, c);
}

/// Direction at a node of slope beside another one: the inverse of facet_shape_slope.
Vec3 direction_at(double alpha, const Vec3& wi, std::size_t node, std::size_t slope) {
    const double c = node_cosine(node), s = sine(c);
    const double sum = std::pow(alpha * (wi.z + c), 2.0);
    const double least = sum + std::pow((wi.z + c) * (wi.z - c) / std::max(wi.x + s, 1e-15), 2.0);
    const double k = std::sqrt(least / (least + 4.0 * wi.x * s));
    const double place = static_cast<double>(slope) / static_cast<double>(slopes - 1);
    const double x = std::clamp(2.0 * k * place / (1.0 + k - place) - 1.0, -1.0, 1.0);
    return kernels::vec3(s * x, s * sine(x), c);
}

/// A direction that light is connected to, and the lobe there that its density is divided by.
struct Target {
    Vec3 w;
    double lobe;
};

/// Walks between the facets of an interface seen from its thinner side.
class ShapeWalk {
public:
    ShapeWalk(const RoughInterface& interface, std::span<const Target> targets)
        : facets_{kernel_distribution(interface.distribution),
                  interface.alpha,
                  interface.eta,
                  1,
                  0,
                  nullptr},
          targets_(targets) {}

    /// Adds what light from wi brings to every target after its first facet.
    void add(const Vec3& wi, WalkNumbers numbers, std::span<double> sums) const {
        kernels::WalkBetweenFacets walk = kernels::walk_between_facets(facets_, wi, numbers.next());
        double weight = stay(walk, numbers, 1.0);
        while (weight > 0.0 && walk.order < 1000) {
            for (std::size_t t = 0; t < targets_.size(); ++t)
                sums[t] += weight * connected(walk, targets_[t].w) / targets_[t].lobe;
            weight = stay(walk, numbers, weight);
        }
    }

private:
    /// Lets the walk meet one facet and takes it to the next one, on the branch that is drawn among
    /// what does not leave. Returns the weight that is left, 0 where it ends.
    double stay(kernels::WalkBetweenFacets& walk, WalkNumbers& numbers, double weight) const {
        const double u1 = numbers.next(), u2 = numbers.next();
        const double choice = numbers.next(), step = numbers.next();
        const Vec3 h =
            kernels::microfacet_sample(facets_.distribution, facets_.alpha, walk.v, u1, u2);
        const double cos_v = kernels::vec3_dot(walk.v, h);
        const double r = kernels::walk_reflectance(walk.surface, std::clamp(cos_v, 0.0, 1.0));
        const Vec3 reflected = kernels::walk_reflected(walk.v, h);
        const double r_stays =
            r * (1.0 - kernels::walk_escape(walk.surface, reflected, walk.height));
        if (r < 1.0) {
            const Vec3 refracted =
                kernels::vec3_scale(kernels::walk_refracted(walk.v, h, walk.surface.eta), -1.0);
            const double t_stays = (1.0 - r) * (1.0 - kernels::walk_escape(walk.surface, refracted,
                                                                           1.0 - walk.height));
            if (choice * (r_stays + t_stays) >= r_stays) {
                kernels::walk_pass_facet(&walk);
                meet(walk, refracted, step);
                return survivor(weight * (r_stays + t_stays), numbers);
            }
            meet(walk, reflected, step);
            return survivor(weight * (r_stays + t_stays), numbers);
        }
        meet(walk, reflected, step);
        return survivor(weight * r_stays, numbers);
    }

    static void meet(kernels::WalkBetweenFacets& walk, const Vec3& w, double step) {
        kernels::walk_meet_facet(&walk, w,
                                 kernels::walk_met_height(walk.surface, w, walk.height, step));
    }

    /// Plays Russian roulette below a weight of 1/1000.
    static double survivor(double weight, WalkNumbers& numbers) {
        constexpr double floor = 1e-3;
        if (weight >= floor)
            return weight;
        return numbers.next() * floor < weight ? floor : 0.0;
    }

    /// Density, 1/sr without the cosine of w, of the light that the facet at which the walk stands
    /// sends along w into the thinner medium, past all others.
    double connected(const kernels::WalkBetweenFacets& walk, const Vec3& w) const {
        double density = 0.0, height = walk.height;
        if (!walk.passed) {
            const Vec3 h = kernels::walk_half_reflected(walk.v, w);
            const double cos_v = std::clamp(kernels::vec3_dot(walk.v, h), 0.0, 1.0);
            density = kernels::walk_reflection_density(
                walk.surface, walk.v, h, kernels::walk_reflectance(walk.surface, cos_v));
        } else {
            const kernels::WalkRefraction r =
                kernels::walk_refraction(walk.surface, walk.v, kernels::vec3_scale(w, -1.0));
            if (r.jacobian > 0.0)
                density = kernels::walk_refraction_density(
                    walk.surface, walk.v, r,
                    1.0 - kernels::walk_reflectance(walk.surface, std::min(r.cos_i, 1.0)));
            height = 1.0 - height;
        }
        return density > 0.0 ? density * kernels::walk_escape(facets_, w, height) / w.z : 0.0;
    }

    kernels::WalkSurface facets_;
    std::span<const Target> targets_;
};

/// Walks come in blocks. A few rare walks of large weight would decide a node by themselves: the
/// largest and the smallest two of its blocks are left out.
constexpr unsigned blocks = 16, left_out = 2;

std::vector<double> means_without_rare(const std::vector<std::vector<double>>& sums) {
    std::vector<double> means(sums.front().size());
    for (std::size_t t = 0; t < means.size(); ++t) {
        std::array<double, blocks> own{};
        for (std::size_t b = 0; b < blocks; ++b)
            own[b] = sums[b][t];
        std::sort(own.begin(), own.end());
        const double sum = std::accumulate(own.begin() + left_out, own.end() - left_out, 0.0);
        means[t] = sum / (blocks - 2 * left_out) * blocks / walk_rule.count;
    }
    return means;
}

/// Ratios for light from one node to those at it and nearer to the normal: [node][slope].
std::vector<double> ratios_from(const RoughInterface& interface, std::size_t node) {
    const Vec3 wi = node_direction(node);
    std::vector<Target> targets;
    for (std::size_t other = node; other < cosines; ++other)
        for (std::size_t slope = 0; slope < slopes; ++slope) {
            const Vec3 w = direction_at(interface.alpha, wi, other, slope);
            targets.push_back(
                {w, kernels::microfacet_reflection(MICROFACET_GGX, interface.alpha, wi, w)});
        }
    const ShapeWalk walk(interface, targets);
    const WalkStream stream(walk_rule, static_cast<unsigned>(node));
    std::vector<std::vector<double>> sums(blocks, std::vector<double>(targets.size(), 0.0));
    for (unsigned k = 0; k < walk_rule.count; ++k)
        walk.add(wi, WalkNumbers(stream, k), sums[k % blocks]);
    return means_without_rare(sums);
}

/// Averages twice over neighbouring slopes: the ratio is smooth, its noise is not.
void smooth_slopes(std::span<double> row) {
    for (int pass = 0; pass < 2; ++pass) {
        double before = row[0];
        for (std::size_t s = 1; s + 1 < row.size(); ++s) {
            const double own = row[s];
            row[s] = 0.25 * (before + row[s + 1]) + 0.5 * own;
            before = own;
        }
    }
}

std::vector<double> compute_shape(const RoughInterface& interface) {
    std::vector<double> table(SHAPE_TABLE_SIZE);
    // isolated: a caller's own parallel loop must not be entered here, while the store is locked
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cosines, 1), [&](const auto& range) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
                std::vector<double> ratios = ratios_from(interface, i);
                for (std::size_t o = i; o < cosines; ++o) {
                    smooth_slopes(std::span(ratios).subspan((o - i) * slopes, slopes));
                    for (std::size_t s = 0; s < slopes; ++s) {
                        const double ratio = ratios[(o - i) * slopes + s];
                        table[(i * cosines + o) * slopes + s] = ratio;
                        table[(o * cosines + i) * slopes + s] = ratio;
                    }
                }
            }
        });
    });
    return table;
}

/// An interface nearby that stands for all of its neighbourhood.
RoughInterface rounded(RoughInterface interface) {
    const double step = interface.eta < 1.1 ? 0.01 : 0.05;
    interface.eta = std::max(std::round(interface.eta / step) * step, 1.01);
    interface.alpha =
        std::min(std::exp2(std::round(std::log2(interface.alpha) * 16.0) / 16.0), 1.0);
    return interface;
}

std::shared_ptr<const std::vector<float>> kept_shape(const RoughInterface& interface) {
    const InterfaceKey key{InterfaceNumbers::FacetShape, interface,
                           std::lround(interface.eta * 1e4)};
    std::optional<std::vector<double>> table =
        read_interface_file(key.file(), key, SHAPE_TABLE_SIZE);
    if (!table) {
        table = compute_shape(interface);
        keep_interface_numbers(key, *table);
    }
    return std::make_shared<std::vector<float>>(table->begin(), table->end());
}

} // namespace

std::shared_ptr<const std::vector<float>> facet_shape(const RoughInterface& interface) {
    if (interface.scattering == Scattering::Single || interface.distribution == Distribution::Blinn)
        return nullptr;
    const RoughInterface nearby = rounded(interface);
    static std::mutex mutex;
    static std::map<std::tuple<double, Distribution, double>,
                    std::shared_ptr<const std::vector<float>>>
        known;
    const std::scoped_lock lock(mutex);
    auto& table = known[{nearby.eta, nearby.distribution, nearby.alpha}];
    if (!table)
        table = kept_shape(nearby);
    return table;
}

} // namespace reradiant
