#pragma once

#include "kernels/core/portable.h"
#include "reradiant/stack_elements.h"
#include "reradiant/stack_model.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace reradiant {

/// A smooth function of the cosine, >= 0, tabulated uniformly in sqrt(c), cubic between the nodes.
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

/// Width of a lobe between two directions in air.
double lobe_width(const LobeShape& lobe, double cos_i, double cos_o);
/// Width to sample a lobe with for a direction in air: that towards its mirror direction.
inline double sampling_width(const LobeShape& lobe, double cosine) {
    return lobe_width(lobe, cosine, cosine);
}

/// Value of the lobe D G2 / (4 ci co), times its table's ratio, 1/sr without the cosine. Both
/// directions are unit vectors in air.
double lobe_value(const LobeShape& lobe, const kernels::Vec3& wi, const kernels::Vec3& wo);

/// Albedo of the lobe D G2 / (4 ci co) itself, by cosine: what its facets send away at once when
/// they reflect everything. Good to 1e-3.
CosineTable lobe_albedo(const LobeShape& lobe);

/// The amplitude whose lobe's albedo comes near `wanted` (unit 1, >= 0) without exceeding it at
/// any node: fixed-point steps on a K a = wanted, K the lobe's own spread (without Fresnel). It is
/// 1 at most, 2 for a shape with a table.
LobeTables fit_lobe(const LobeShape& lobe, const std::function<double(double cosine)>& wanted);

/// Returns the amplitudes of a lobe that goes from one side to another, whose albedos from both
/// sides come near `wanted` likewise: between directions of cosines c and d on the two sides it is
/// a(c) b(d) times its shape, by steps of Sinkhorn and Knopp 1967. `lobes`: its shape as seen from
/// either side.
std::array<LobeTables, 2>
fit_lobes(const std::array<LobeShape, 2>& lobes,
          const std::array<std::function<double(double cosine)>, 2>& wanted);

/// Returns the lobe, without its distribution, of what an interface of a stack reflects through the
/// rough interfaces above it.
LobeShape deeper_lobe(std::span<const StackElement> stack, std::size_t element);

} // namespace reradiant
