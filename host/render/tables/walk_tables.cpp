#include "host/render/tables/walk_tables.h"

#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/walk/walk_surface.h"
#include "host/render/plan/material_plan.h"
#include "host/render/tables/substrate_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace reradiant {

namespace {

/// Distances in a scattering slab are sampled with extinctions down to this share of the largest:
/// where a lane's is smaller still, weights bounded by WALK_REFERENCES make up for it.
constexpr double least_reference = 1e-3;

/// A surface of a stack, or of its substrate; nothing beneath it yet.
WalkPartRecord surface_part(double alpha, Distribution distribution, Scattering scattering) {
    WalkPartRecord part{};
    part.eta = part.ior = 1.0f;
    part.alpha = static_cast<float>(alpha);
    part.distribution = static_cast<std::uint32_t>(kernel_distribution(distribution));
    part.multiple = scattering == Scattering::Multiple ? 1u : 0u;
    part.albedo = 1.0f;
    part.cavities = part.reflectance = part.bounced = NO_INDEX;
    part.extinction = part.scattering = part.flakes = NO_INDEX;
    return part;
}

/// Extinctions in equal ratios from the smallest lane's to the largest's, and the largest albedo.
void set_references(const SlabDepths& depths, WalkPartRecord& part) {
    double least = std::numeric_limits<double>::infinity(), most = 0.0, albedo = 0.0;
    const std::size_t count = depths.absorption.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double extinction = depths.extinction(i);
        least = std::min(least, extinction);
        most = std::max(most, extinction);
        if (extinction > 0.0)
            albedo = std::max(albedo, depths.scattering[i] / extinction);
    }
    least = std::max(least, least_reference * most);
    for (int r = 0; r < WALK_REFERENCES; ++r)
        part.references[r] =
            static_cast<float>(least * std::pow(most / least, r / (WALK_REFERENCES - 1.0)));
    part.albedo = static_cast<float>(albedo);
}

class WalkTables {
public:
    WalkTables(const Material& material, const MaterialPlan& plan,
               const WavelengthPlan& wavelengths, SceneTables& out)
        : material_(material), layers_(material.stack.layers), plan_(plan), out_(out),
          lanes_(wavelengths, out.tables) {}

    void append() {
        record_.walk = static_cast<std::uint32_t>(out_.walk_parts.size());
        record_.layer_count = static_cast<std::uint32_t>(layers_.size());
        for (std::size_t k = 0; k < layers_.size(); ++k)
            append_layer(k);
        append_substrate_part();
        append_flakes();
        out_.materials.push_back(record_);
    }

private:
    void append_layer(std::size_t k) {
        const Layer& layer = layers_[k];
        const double ior = layer.ior(reference_nm);
        WalkPartRecord part = surface_part(layer.alpha, layer.distribution, layer.scattering);
        part.eta = static_cast<float>(ior / ior_of_medium(k));
        part.ior = static_cast<float>(ior);
        const WalkSurface surface = interface_surface(stack_at(material_.stack, reference_nm), k);
        if (surface.lost)
            part.cavities = append_cavities(*surface.lost);
        append_slab(plan_.slabs[k], layer.anisotropy, part);
        out_.walk_parts.push_back(part);
    }

    /// Returns the IOR of the medium above interface `k` at reference_nm; 1 above the first.
    double ior_of_medium(std::size_t k) const {
        return k > 0 ? layers_[k - 1].ior(reference_nm) : 1.0;
    }

    std::uint32_t append_cavities(const LostFlux& flux) {
        const std::uint32_t offset = lanes_.here();
        for (const double value : flux.table())
            lanes_.append(value);
        return offset;
    }

    void append_slab(const SlabDepths& depths, double anisotropy, WalkPartRecord& part) {
        if (!depths.absorbs() && !depths.scatters())
            return;
        const auto at = [this](int phase, int lane) {
            return static_cast<std::size_t>(phase * lanes_.lanes() + lane);
        };
        part.least_depth = static_cast<float>(
            *std::min_element(depths.absorption.begin(), depths.absorption.end()));
        part.extinction = lanes_.append_lanes(
            [&](int phase, int lane) { return depths.extinction(at(phase, lane)); });
        if (!depths.scatters())
            return;
        part.scattering = lanes_.append_lanes(
            [&](int phase, int lane) { return depths.scattering[at(phase, lane)]; });
        part.anisotropy = static_cast<float>(anisotropy);
        set_references(depths, part);
    }

    /// The operator of the bare substrate, M / pi: what the stack sends back to it is walked.
    void append_substrate_part() {
        Material bare = material_;
        bare.stack.layers.clear();
        const MaterialOptics optics(bare, Model::Adding, lanes_.plan());
        const LaneOperator middle =
            append_substrate(bare, Model::Adding, optics, *plan_.on_cells, lanes_, record_, out_);
        if (material_.substrate.type == SubstrateType::Conductor) {
            append_conductor(material_.substrate.conductor, ior_of_medium(layers_.size()));
            return;
        }
        WalkPartRecord part = surface_part(0.0, Distribution::Ggx, Scattering::Single);
        part.albedo = static_cast<float>(
            std::clamp(std::numbers::pi * middle.row_sums().maxCoeff(), 0.0, 1.0));
        out_.walk_parts.push_back(part);
    }

    /// A conductor in a medium. Its reflectance at a facet is tabulated over the cosine there.
    void append_conductor(const Conductor& conductor, double ior_above) {
        const auto reflectance = [&](double cosine, int phase, int lane) {
            const double nm = lanes_.plan().wavelength_nm(lane, phase);
            return facet_reflectance(conductor_at(conductor, nm), ior_above, cosine);
        };
        WalkPartRecord part =
            surface_part(conductor.alpha, conductor.distribution, conductor.scattering);
        part.reflectance = lanes_.append_nodes_of_lanes(reflectance);
        double largest = 0.0;
        for (int lane = 0; lane < lanes_.lanes(); ++lane)
            largest = std::max(largest, reflectance(1.0, lanes_.phases() / 2, lane));
        part.albedo = static_cast<float>(largest);
        const auto surface = [&](double nm) {
            return conductor_surface(conductor_at(conductor, nm), ior_above, nm);
        };
        if (const auto flux = surface(reference_nm).lost) {
            part.cavities = append_cavities(*flux);
            part.bounced = lanes_.append_lanes([&](int phase, int lane) {
                return surface(lanes_.plan().wavelength_nm(lane, phase)).lost_reflectance;
            });
        }
        out_.walk_parts.push_back(part);
    }

    /// Sheets of flakes, after the substrate.
    void append_flakes() {
        for (std::size_t k = 0; k < layers_.size(); ++k) {
            if (!layers_[k].flakes || !(layers_[k].flakes->coverage > 0.0))
                continue;
            WalkPartRecord& slab = out_.walk_parts[record_.walk + k];
            slab.flakes = static_cast<std::uint32_t>(out_.walk_parts.size()) - record_.walk;
            slab.coverage = static_cast<float>(layers_[k].flakes->coverage);
            append_conductor(layers_[k].flakes->reflector, layers_[k].ior(reference_nm));
        }
    }

    const Material& material_;
    const std::vector<Layer>& layers_;
    const MaterialPlan& plan_;
    SceneTables& out_;
    LaneTables lanes_;
    MaterialRecord record_{};
};

} // namespace

void append_walk_material(const Material& material, const MaterialPlan& plan,
                          const WavelengthPlan& wavelengths, SceneTables& tables) {
    WalkTables(material, plan, wavelengths, tables).append();
}

} // namespace reradiant
