#include "host/layers/models/lobe_ratios.h"

#include "host/layers/rough/interface_file.h"
#include "kernels/scatter/lobe_ratio.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>

namespace reradiant {

using kernels::Vec3;

namespace {

constexpr std::size_t slopes = LOBE_RATIO_SLOPES, azimuths = LOBE_RATIO_AZIMUTHS;
/// Walks from every node of cosine.
constexpr unsigned walks = 4096, blocks = 16;
/// No more than this much light is put where the lobe itself has next to none.
constexpr double largest_ratio = 64.0;
/// Directions nearer to the horizon than this are not asked for.
constexpr double least_cosine = 1e-3;

Vec3 direction_at_node(std::size_t node) {
    const double c = kernels::lobe_ratio_node_cosine(static_cast<kernels::uint>(node));
    return kernels::vec3(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
}

/// The direction whose half vector with `own` lies at a node of slope and of azimuth.
Vec3 direction_at_node(const Vec3& own, double width, std::size_t slope, std::size_t azimuth) {
    const double x = static_cast<double>(slope) / (slopes - 1);
    const double most = kernels::lobe_ratio_largest(own.z);
    const double k = kernels::lobe_ratio_middle(width, own.z);
    const double m = most * k * x / (1.0 + k - x);
    const double phi = std::numbers::pi * static_cast<double>(azimuth) / (azimuths - 1);
    const Vec3 h =
        kernels::vec3_normalise(kernels::vec3(m * std::cos(phi), m * std::sin(phi), 1.0));
    return kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * kernels::vec3_dot(own, h)), own);
}

/// Nodes of slope and azimuth whose directions lie above the horizon, and the plain lobe there.
struct Targets {
    std::vector<Vec3> directions;
    std::vector<double> lobes;
    std::vector<std::size_t> nodes; ///< in the table's part for the cosine

    Targets(const LobeShape& lobe, const Vec3& own) {
        const double width = sampling_width(lobe, 1.0);
        for (std::size_t node = 0; node < slopes * azimuths; ++node) {
            const Vec3 w = direction_at_node(own, width, node / azimuths, node % azimuths);
            if (!(w.z > least_cosine))
                continue;
            directions.push_back(w);
            lobes.push_back(lobe_value(lobe, own, w));
            nodes.push_back(node);
        }
    }
};

/// Mean over walks. A few rare ones of large weight would decide a value by themselves: none of the
/// blocks that walks come in counts for more than four times the median of all.
double mean_of(const std::vector<std::vector<double>>& sums, std::size_t target) {
    constexpr double most = 4.0;
    std::array<double, blocks> own{};
    for (std::size_t b = 0; b < blocks; ++b)
        own[b] = sums[b][target];
    std::ranges::sort(own);
    const double median = 0.5 * (own[blocks / 2 - 1] + own[blocks / 2]);
    double sum = 0.0;
    for (const double block : own)
        sum += median > 0.0 ? std::min(block, most * median) : block;
    return sum / walks;
}

/// At normal incidence all azimuths are the same.
void average_azimuths(std::vector<double>& ratios) {
    for (auto row = ratios.begin(); row != ratios.end(); row += azimuths)
        std::fill_n(row, azimuths, std::accumulate(row, row + azimuths, 0.0) / azimuths);
}

/// Ratios of light from one node of cosine: [slope][azimuth]. Beneath the horizon a slope takes the
/// ratio of the next smaller one.
std::vector<double> ratios_from(const AimedLobeWalk& aimed, const LobeShape& lobe,
                                std::size_t node) {
    const Vec3 own = direction_at_node(node);
    const Targets targets(lobe, own);
    const LobeWalk walk = aimed(own, targets.directions);
    std::vector<std::vector<double>> sums(blocks, std::vector<double>(targets.nodes.size()));
    for (unsigned k = 0; k < walks; ++k) {
        WalkRandom random(0, k, node);
        walk(random, sums[k % blocks]);
    }
    std::vector<double> ratios(slopes * azimuths, -1.0);
    for (std::size_t t = 0; t < targets.nodes.size(); ++t) {
        const double value = mean_of(sums, t);
        ratios[targets.nodes[t]] =
            value < largest_ratio * targets.lobes[t] ? value / targets.lobes[t] : largest_ratio;
    }
    for (std::size_t t = 0; t < ratios.size(); ++t)
        if (ratios[t] < 0.0)
            ratios[t] = t >= azimuths ? ratios[t - azimuths] : 0.0;
    if (own.x == 0.0)
        average_azimuths(ratios);
    return ratios;
}

std::vector<double> compute_ratios(const LobeShape& lobe, const AimedLobeWalk& aimed) {
    std::vector<double> table(LOBE_RATIO_SIZE);
    // isolated: a caller's own parallel loop must not be entered here, while the store is locked
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, LOBE_RATIO_COSINES, 1), [&](const auto& range) {
                for (std::size_t i = range.begin(); i != range.end(); ++i)
                    std::ranges::copy(ratios_from(aimed, lobe, i),
                                      table.begin() +
                                          static_cast<std::ptrdiff_t>(i * slopes * azimuths));
            });
    });
    // 1 where the lobe is highest at normal incidence: tables of media with other indices of
    // refraction then differ in shape alone
    const double highest = table[(LOBE_RATIO_COSINES - 1) * slopes * azimuths];
    for (double& ratio : table)
        ratio /= highest > 0.0 ? highest : 1.0;
    return table;
}

std::shared_ptr<const std::vector<float>>
kept_ratios(const LobeShape& lobe, const AimedLobeWalk& aimed, const std::vector<double>& numbers) {
    const InterfaceKey key{InterfaceNumbers::LobeRatio, {}, 0, numbers};
    std::optional<std::vector<double>> table =
        read_interface_file(key.file(), key, LOBE_RATIO_SIZE);
    if (!table) {
        table = compute_ratios(lobe, aimed);
        keep_interface_numbers(key, *table);
    }
    return std::make_shared<std::vector<float>>(table->begin(), table->end());
}

} // namespace

std::shared_ptr<const std::vector<float>>
lobe_ratios(const LobeShape& plain, const AimedLobeWalk& aimed, const std::vector<double>& key) {
    static std::mutex mutex;
    static std::map<std::vector<double>, std::shared_ptr<const std::vector<float>>> known;
    LobeShape lobe = plain;
    lobe.table = nullptr;
    const std::scoped_lock lock(mutex);
    auto& table = known[key];
    if (!table)
        table = kept_ratios(lobe, aimed, key);
    return table;
}

double rounded_ior(double ior) {
    const double step = std::fabs(ior - 1.0) < 0.1 ? 0.01 : 0.05;
    return std::round(ior / step) * step;
}

double rounded_size(double size) {
    return size > 0.0 ? std::exp2(std::round(std::log2(size) * 16.0) / 16.0) : 0.0;
}

void append_key(const SurfaceValues& surface, std::vector<double>& key) {
    key.insert(key.end(),
               {surface.ior_above, surface.ior_below, surface.scatters() ? surface.alpha : 0.0,
                static_cast<double>(surface.distribution),
                static_cast<double>(surface.scattering)});
}

SurfaceValues rounded(const SurfaceValues& surface) {
    SurfaceValues nearby = surface;
    if (surface.scatters())
        nearby.alpha = std::min(rounded_size(surface.alpha), 1.0);
    nearby.ior_above = rounded_ior(surface.ior_above);
    nearby.ior_below = rounded_ior(surface.ior_below);
    nearby.film = {};
    nearby.wavelength_nm = 0.0;
    return nearby.scatters() == surface.scatters() ? nearby : surface;
}

} // namespace reradiant
