#pragma once

#include "reradiant/stack_elements.h"
#include "reradiant/stack_model.h"

#include <functional>
#include <memory>
#include <vector>

namespace reradiant {

/// A smooth function of the cosine, tabulated uniformly in sqrt(c), cubic between the nodes.
class CosineTable {
public:
    static constexpr int nodes = 65;
    static double node_cosine(int node);

    CosineTable() : values_(nodes, 0.0) {}
    explicit CosineTable(std::vector<double> values) : values_(std::move(values)) {}
    double operator()(double cosine) const;
    const std::vector<double>& values() const { return values_; }

private:
    std::vector<double> values_;
};

/// Lobe a(ci) a(co) D G2 / (4 ci co) in air: its amplitude and its albedo by cosine.
struct LobeTables {
    CosineTable amplitude, albedo;
};

/// Albedo of the lobe D G2 / (4 ci co) itself, by cosine: what its facets send away at once when
/// they reflect everything. Good to 1e-3.
CosineTable lobe_albedo(const LobeShape& lobe);

/// The amplitude whose lobe's albedo comes near `wanted` (unit 1, >= 0) without exceeding it at
/// any node: fixed-point steps on a K a = wanted, K the lobe's own spread (without Fresnel).
LobeTables fit_lobe(const LobeShape& lobe, const std::function<double(double cosine)>& wanted);

/// Width, in the air half vector, of the lobe that the interface at `element` reflects through
/// the rough interfaces above it: variances add up (Belcour 2018, section 4), a reflection k at
/// depth counts n_above alpha_k, a passage through interface j (n_j / n_(j-1) - 1) alpha_j twice,
/// there and back. Rounded to 1/4096, so that tables can be shared, between that and 1.
double effective_lobe_width(std::span<const StackElement> stack, std::size_t element);

} // namespace reradiant
