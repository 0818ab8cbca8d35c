#include "host/layers/models/weidlich_wilkie_residual.h"

#include "host/layers/rough/facet_interreflection.h"
#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/stack/quadrature.h"
#include "kernels/scatter/fresnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// A `Way` follows light down from a direction in air, refracted at the macroscopic normal.
struct Way {
    double cosine, ior = 1.0, through = 1.0;

    void cross(const LayerValues& layer) {
        through *= 1.0 - facet_reflectance(layer, ior, cosine);
        cosine = kernels::fresnel_cos_transmitted(cosine, layer.ior / ior);
        ior = layer.ior;
        const double tau = layer.tau + layer.tau_scattering;
        through = cosine > 0.0 ? through * std::exp(-tau / cosine) : 0.0;
        through *= 1.0 - layer.flake_coverage;
    }
};

double mean_of(const CosineTable& table) {
    return integrate_sin2(0.0, 1.0, 64, [&](double c) { return 2.0 * c * table(c); });
}

/// Returns V m e of a part whose share is `own` beneath all of `above`.
CosineTable seen_from_air(const StackValues& above, const CosineTable& own) {
    const double mean = mean_of(own);
    if (!(mean > 0.0))
        return {};
    std::vector<double> seen;
    for (int node = 0; node < CosineTable::nodes; ++node) {
        Way way{CosineTable::node_cosine(node)};
        for (const LayerValues& layer : above)
            way.cross(layer);
        seen.push_back(way.through > 0.0 ? way.through * own(way.cosine) : 0.0);
    }
    const double share = std::min(mean_of(CosineTable(seen)) / mean, 1.0);
    for (double& value : seen)
        value *= share;
    return CosineTable(std::move(seen));
}

void add(CosineTable& sum, const CosineTable& part, double factor) {
    std::vector<double> values = sum.values();
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] += factor * part.values()[i];
    sum = CosineTable(std::move(values));
}

} // namespace

WeidlichWilkieResidual::WeidlichWilkieResidual(const StackValues& stack,
                                               const std::optional<ConductorValues>& conductor) {
    StackValues above;
    double ior = 1.0;
    for (const LayerValues& layer : stack) {
        add(total_, seen_from_air(above, facet_interreflection(layer, ior)), 1.0);
        ior = layer.ior;
        above.push_back(layer);
        if (layer.flake_coverage > 0.0) {
            above.back().flake_coverage = 0.0; // a sheet does not stand before itself
            add(total_, seen_from_air(above, facet_interreflection(layer.flakes, ior)),
                layer.flake_coverage);
            above.back() = layer;
        }
    }
    if (conductor) {
        conductor_ = seen_from_air(above, facet_interreflection(*conductor, ior));
        add(total_, conductor_, 1.0);
    }
    average_ = mean_of(total_);
}

double WeidlichWilkieResidual::value(double cos_i, double cos_o) const {
    return average_ > 0.0 ? total_(cos_i) * total_(cos_o) * std::numbers::inv_pi / average_ : 0.0;
}

} // namespace reradiant
