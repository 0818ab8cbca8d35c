#include "host/layers/angular/substrate_arrivals.h"

#include "host/layers/stack/directions.h"
#include "host/layers/walk/walk.h"
#include "kernels/scatter/oren_nayar.h"
#include "kernels/scatter/oren_nayar_shape.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <utility>

namespace reradiant {

namespace {

constexpr std::uint64_t walks = 8192;

/// Returns the order at an index: 0, 1, 2, 4, 6, ...
int order_at(std::size_t index) {
    return index < 2 ? static_cast<int>(index) : 2 * static_cast<int>(index) - 2;
}

/// Coefficient of cos(m phi) in max(0, cos phi).
double coefficient(std::size_t index) {
    if (index < 2)
        return index == 0 ? std::numbers::inv_pi : 0.5;
    const double m = order_at(index), sign = index % 2 == 0 ? 1.0 : -1.0;
    return sign * 2.0 * std::numbers::inv_pi / (m * m - 1.0);
}

/// A positive number nearby that stands for all of its neighbourhood; 1 stands for itself.
double rounded(double value, double steps_of_e) {
    return value > 0.0 ? std::exp(std::round(std::log(value) * steps_of_e) / steps_of_e) : value;
}

/// A stack nearby without what hardly changes where light arrives.
StackElements simplified(std::span<const StackElement> stack) {
    StackElements simple(stack.begin(), stack.end());
    const auto medium = [](double ior) { return rounded(ior, 256.0); };
    for (StackElement& element : simple) {
        if (auto* surface = std::get_if<SurfaceValues>(&element)) {
            surface->ior_above = medium(surface->ior_above);
            surface->ior_below = medium(surface->ior_below);
            surface->film = {};
            surface->wavelength_nm = 0.0;
        } else if (auto* slab = std::get_if<SlabValues>(&element)) {
            slab->ior = medium(slab->ior);
            slab->tau = slab->tau_dyes = 0.0;
            slab->tau_scattering = rounded(slab->tau_scattering, 16.0);
        }
    }
    return simple;
}

} // namespace

/// Sums over the walks from one node, at azimuth 0.
class SubstrateArrivals::Sums {
public:
    void add(const WalkArrival& arrival) {
        const double c = std::min(arrival.from.z, 1.0);
        const auto cell = std::min(static_cast<std::size_t>(c * cells), cells - 1);
        weights_[cell] += arrival.weight;
        sums_.cosine[cell] += arrival.weight * c;
        const double sine = std::hypot(arrival.from.x, arrival.from.y);
        const double x = sine > 0.0 ? arrival.from.x / sine : 1.0;
        sums_.sines[0][cell] += arrival.weight * sine;
        sums_.sines[1][cell] += arrival.weight * sine * x;
        const double twice = 2.0 * x * x - 1.0; // cos(2 azimuth); then by Chebyshev's recurrence
        double before = 1.0, here = twice;
        for (std::size_t order = 2; order < orders; ++order) {
            sums_.sines[order][cell] += arrival.weight * sine * here;
            before = std::exchange(here, 2.0 * twice * here - before);
        }
    }

    FromNode means() const {
        FromNode means = sums_;
        double total = 0.0;
        for (std::size_t cell = 0; cell < cells; ++cell) {
            total += weights_[cell];
            means.cosine[cell] /= weights_[cell] > 0.0 ? weights_[cell] : 1.0;
        }
        for (auto& order : means.sines)
            for (double& sine : order)
                sine /= total > 0.0 ? total : 1.0;
        return means;
    }

private:
    std::array<double, cells> weights_{};
    FromNode sums_;
};

SubstrateArrivals::SubstrateArrivals(const StackElements& stack) : nodes_(SHAPE_COSINES) {
    const LayerWalk walk(stack);
    // isolated: a caller's own parallel loop must not be entered here, while the store is locked
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(std::size_t{0}, nodes_.size(), [&](std::size_t node) {
            const kernels::Vec3 wi = direction_at(
                kernels::oren_nayar_node_cosine(static_cast<kernels::uint>(node)), 0.0);
            Sums sums;
            for (std::uint64_t k = 0; k < walks; ++k) {
                WalkRandom random(0, k, node);
                const WalkArrival arrival = walk.arrival(wi, random);
                if (arrival.weight > 0.0)
                    sums.add(arrival);
            }
            nodes_[node] = sums.means();
        });
    });
}

double SubstrateArrivals::mean_value(std::size_t node, double sigma, double cosine) const {
    const FromNode& from = nodes_[node];
    double sum = 0.0;
    for (std::size_t cell = 0; cell < cells; ++cell)
        if (from.cosine[cell] > 0.0)
            sum += from.sines[0][cell] / std::max(from.cosine[cell], cosine);
    return kernels::oren_nayar_a(sigma) + kernels::oren_nayar_b(sigma) * coefficient(0) *
                                              std::sqrt((1.0 - cosine) * (1.0 + cosine)) * sum;
}

/// Means of sin sin cos(m phi) / (the larger cosine) over what arrives from two nodes, by order.
std::array<double, SubstrateArrivals::orders> SubstrateArrivals::mean_orders(const FromNode& i,
                                                                             const FromNode& o) {
    std::array<double, orders> sums{};
    for (std::size_t a = 0; a < cells; ++a) {
        for (std::size_t b = 0; i.cosine[a] > 0.0 && b < cells; ++b) {
            const double larger = std::max(i.cosine[a], o.cosine[b]);
            for (std::size_t order = 0; order < orders; ++order)
                sums[order] += i.sines[order][a] * o.sines[order][b] / larger;
        }
    }
    return sums;
}

std::vector<float> SubstrateArrivals::spread_values(double sigma) const {
    std::vector<float> table;
    table.reserve(SHAPE_TABLE_SIZE);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        for (std::size_t o = 0; o < nodes_.size(); ++o) {
            const auto mean = mean_orders(nodes_[std::max(i, o)], nodes_[std::min(i, o)]);
            for (std::size_t place = 0; place < SHAPE_PLACES; ++place) {
                const double phi =
                    std::acos(2.0 * static_cast<double>(place) / (SHAPE_PLACES - 1.0) - 1.0);
                double sum = 0.0;
                for (std::size_t order = 0; order < orders; ++order)
                    sum += coefficient(order) * mean[order] * std::cos(order_at(order) * phi);
                table.push_back(static_cast<float>(kernels::oren_nayar_a(sigma) +
                                                   kernels::oren_nayar_b(sigma) * sum));
            }
        }
    return table;
}

std::shared_ptr<const SubstrateArrivals>
SubstrateArrivals::of(std::span<const StackElement> stack) {
    static std::mutex mutex;
    static std::vector<std::pair<StackElements, std::shared_ptr<const SubstrateArrivals>>> known;
    const StackElements simple = simplified(stack);
    const std::scoped_lock lock(mutex);
    for (const auto& [own, arrivals] : known)
        if (own == simple)
            return arrivals;
    known.emplace_back(simple,
                       std::shared_ptr<const SubstrateArrivals>(new SubstrateArrivals(simple)));
    return known.back().second;
}

} // namespace reradiant
