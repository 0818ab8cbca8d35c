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
    double cosine, through = 1.0;

    void cross(const StackElement& element) {
        if (const auto* slab = std::get_if<SlabValues>(&element)) {
            through = cosine > 0.0 ? through * std::exp(-slab->depth() / cosine) : 0.0;
        } else if (const auto* flakes = std::get_if<FlakesValues>(&element)) {
            through *= 1.0 - flakes->coverage;
        } else if (const auto* surface = std::get_if<SurfaceValues>(&element)) {
            through *= 1.0 - facet_reflectance(*surface, cosine);
            cosine =
                kernels::fresnel_cos_transmitted(cosine, surface->ior_below / surface->ior_above);
        }
    }
};

double mean_of(const CosineTable& table) {
    return integrate_sin2(0.0, 1.0, 64, [&](double c) { return 2.0 * c * table(c); });
}

/// Returns V m e of a part whose share is `own` beneath all of `above`.
CosineTable seen_from_air(std::span<const StackElement> above, const CosineTable& own) {
    const double mean = mean_of(own);
    if (!(mean > 0.0))
        return {};
    std::vector<double> seen;
    for (int node = 0; node < CosineTable::nodes; ++node) {
        Way way{CosineTable::node_cosine(node)};
        for (const StackElement& element : above)
            way.cross(element);
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

WeidlichWilkieResidual::WeidlichWilkieResidual(const StackElements& stack) {
    for (std::size_t e = 0; e < stack.size(); ++e) {
        const SurfaceValues* surface = surface_of(stack[e]);
        if (!surface)
            continue;
        const CosineTable seen =
            seen_from_air(std::span(stack).first(e), facet_interreflection(*surface));
        add(total_, seen, coverage_of(stack[e]));
        if (surface == conductor_of(stack))
            conductor_ = seen;
    }
    average_ = mean_of(total_);
}

double WeidlichWilkieResidual::value(double cos_i, double cos_o) const {
    return average_ > 0.0 ? total_(cos_i) * total_(cos_o) * std::numbers::inv_pi / average_ : 0.0;
}

} // namespace reradiant
