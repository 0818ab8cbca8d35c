#include "host/layers/rough/facet_interreflection.h"

#include "host/layers/rough/facet_orders.h"
#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/rough/interface_operator.h"
#include "host/layers/stack/quadrature.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

namespace reradiant {

namespace {

template <typename Function>
double cosine_mean(const Function& f) {
    return integrate_sin2(0.0, 1.0, 24, [&](double c) { return 2.0 * c * f(c); });
}

/// Follows Kulla and Conty 2017, with both meetings after the first counted at the mean
/// reflectance: (1 - E) F^2 Em / (1 - F (1 - Em)), Em the cosine-weighted mean of E.
std::vector<double> cavity_interreflection(const CosineTable& albedo, double reflectance) {
    const double mean = cosine_mean(albedo);
    const double scale = reflectance * reflectance * mean / (1.0 - reflectance * (1.0 - mean));
    std::vector<double> values;
    for (const double e : albedo.values())
        values.push_back(scale * std::max(1.0 - e, 0.0));
    return values;
}

/// Counts every meeting at the mean reflectance.
std::vector<double> smith_interreflection(const Eigen::MatrixXd& orders, double reflectance) {
    Eigen::VectorXd powers(orders.cols());
    for (Eigen::Index k = 0; k < powers.size(); ++k)
        powers(k) = std::pow(reflectance, static_cast<double>(k + 2));
    const Eigen::VectorXd values = orders * powers;
    return {values.data(), values.data() + values.size()};
}

CosineTable opaque_interreflection(const SurfaceValues& surface) {
    const LobeShape lobe{surface.distribution, surface.alpha};
    const double mean = cosine_mean([&](double c) { return facet_reflectance(surface, c); });
    return CosineTable(lobe.distribution == Distribution::Blinn
                           ? cavity_interreflection(lobe_albedo(lobe), mean)
                           : smith_interreflection(*facet_orders(lobe), mean));
}

/// Returns the mean share of the lobe over each cell of the denser side, which operators do not
/// keep.
Eigen::VectorXd first_lobe_from_below(const InterfaceOperator& op) {
    RoughInterface once = op.interface;
    once.scattering = Scattering::Single;
    const LatticeRule rule = lattice_rule(once);
    Eigen::VectorXd lobe = Eigen::VectorXd::Zero(op.below.cells());
    std::vector<Departure> departures;
    for (int cell = 0; cell < op.below.cells(); ++cell) {
        const double low = op.below.edges[static_cast<std::size_t>(cell)];
        const double high = op.below.edges[static_cast<std::size_t>(cell) + 1];
        const WalkStream stream(rule, static_cast<unsigned>(cell));
        for (unsigned walk = 0; walk < rule.count; ++walk) {
            WalkNumbers numbers(stream, walk);
            const double c = std::sqrt(low * low + (high - low) * (high + low) * numbers.next());
            departures.clear();
            lobe(cell) += scatter_at_interface(once, true, std::min(c, 1.0), numbers, departures);
        }
    }
    return lobe / rule.count;
}

CosineTable dielectric_interreflection(const RoughInterface& interface, bool from_below) {
    const auto op = interface_operator(interface);
    const AngularGrid& side = from_below ? op->below : op->above;
    const Eigen::Index cells = side.cells();
    const auto reflection = from_below ? op->exchange.bottomRightCorner(cells, cells)
                                       : op->exchange.topLeftCorner(cells, cells);
    const Eigen::VectorXd reflected =
        reflection.colwise().sum().transpose().cwiseQuotient(side.etendue());
    const Eigen::VectorXd first = from_below ? first_lobe_from_below(*op) : op->first_lobe;
    const CellFit fit(side);
    const Eigen::VectorXd coefficients = fit.coefficients(reflected - first);
    std::vector<double> values;
    for (int node = 0; node < CosineTable::nodes; ++node) {
        // the fit's ripple about nothing is not light
        values.push_back(std::max(fit.evaluate(coefficients, CosineTable::node_cosine(node)), 0.0));
    }
    return CosineTable(std::move(values));
}

/// Keeps the tables: a grey material asks for the same one at every wavelength.
CosineTable known_interreflection(const RoughInterface& interface, bool from_below) {
    using Key = std::tuple<double, Distribution, double, bool>;
    static std::mutex mutex;
    static std::map<Key, CosineTable> known;
    const Key key{interface.eta, interface.distribution, interface.alpha, from_below};
    const std::scoped_lock lock(mutex);
    const auto found = known.find(key);
    if (found != known.end())
        return found->second;
    return known.emplace(key, dielectric_interreflection(interface, from_below)).first->second;
}

} // namespace

CosineTable facet_interreflection(const SurfaceValues& surface) {
    if (!(surface.alpha > 0.0) || surface.scattering == Scattering::Single)
        return {};
    if (surface.is_conductor || surface.has_film())
        return opaque_interreflection(surface);
    if (!surface.scatters())
        return {};
    const double eta = surface.ior_below / surface.ior_above;
    // operators are rounded to 1e-4 of the ratio: so are these
    const double ratio = std::round(std::max(eta, 1.0 / eta) * 1e4) * 1e-4;
    return known_interreflection({ratio, surface.distribution, surface.alpha, surface.scattering},
                                 eta < 1.0);
}

} // namespace reradiant
