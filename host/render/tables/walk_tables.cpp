#include "host/render/tables/walk_tables.h"

#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/walk/walk_surface.h"
#include "host/render/plan/material_plan.h"
#include "host/render/tables/substrate_operator.h"
#include "host/render/tables/substrate_tables.h"
#include "host/scene/model/closed_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace reradiant {

namespace {

/// Distances in a scattering slab are sampled with extinctions down to this share of the largest:
/// where a lane's is smaller still, weights bounded by WALK_REFERENCES make up for it.
constexpr double least_reference = 1e-3;
/// Of the events in a slab that scatters and holds dyes either kind takes this share at least.
constexpr double least_branch = 0.1;

/// A surface of a stack, or of its substrate; nothing beneath it yet.
WalkPartRecord surface_part(const SurfaceValues& surface) {
    WalkPartRecord part{};
    part.eta = part.ior = 1.0f;
    part.alpha = static_cast<float>(surface.alpha);
    part.distribution = static_cast<std::uint32_t>(kernel_distribution(surface.distribution));
    part.multiple = surface.scattering == Scattering::Multiple ? 1u : 0u;
    part.albedo = 1.0f;
    part.cavities = part.reflectance = part.bounced = NO_INDEX;
    part.extinction = part.scattering = part.flakes = part.emission = NO_INDEX;
    return part;
}

/// Extinctions in equal ratios from the smallest lane's to the largest's, and the largest albedo.
/// Where a lane receives more from dyes than it loses, what it receives counts: `emitted`, the sums
/// of emission over the lanes of excitation, or nothing.
void set_references(const SlabDepths& depths, const std::vector<double>& emitted,
                    WalkPartRecord& part) {
    double least = std::numeric_limits<double>::infinity(), most = 0.0, albedo = 0.0;
    const std::size_t count = depths.absorption.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double sent = depths.scattering[i] + (emitted.empty() ? 0.0 : emitted[i]);
        const double events = std::max(depths.extinction(i), sent);
        least = std::min(least, events);
        most = std::max(most, events);
        if (events > 0.0)
            albedo = std::max(albedo, sent / events);
    }
    least = std::max(least, least_reference * most);
    for (int r = 0; r < WALK_REFERENCES; ++r)
        part.references[r] =
            static_cast<float>(least * std::pow(most / least, r / (WALK_REFERENCES - 1.0)));
    part.albedo = static_cast<float>(albedo);
}

class WalkTables {
public:
    /// `from`: the side of a sheet that the camera sees.
    WalkTables(const Material& material, const MaterialPlan& plan,
               const WavelengthPlan& wavelengths, Side from, SceneTables& out)
        : material_(material), plan_(plan), from_(from),
          stack_(material_at(material, reference_nm, from)), out_(out),
          lanes_(wavelengths, out.tables) {
        for (int phase = 0; phase < lanes_.phases(); ++phase)
            for (int lane = 0; lane < lanes_.lanes(); ++lane)
                lane_stacks_.push_back(
                    material_at(material, wavelengths.wavelength_nm(lane, phase), from));
    }

    void append() {
        record_.walk = static_cast<std::uint32_t>(out_.walk_parts.size());
        record_.dyes = record_.other_side = NO_INDEX;
        const std::size_t end = above_substrate(stack_).size();
        for (std::size_t e = 0; e < end; ++e) {
            if (const auto* interface = std::get_if<SurfaceValues>(&stack_[e]))
                append_interface(*interface);
            else if (const auto* slab = std::get_if<SlabValues>(&stack_[e]))
                append_slab(slab->anisotropy, out_.walk_parts.back());
        }
        if (!material_.stack.is_sheet()) {
            append_substrate_part();
            append_flakes();
        }
        out_.materials.push_back(record_);
    }

private:
    std::size_t index(int phase, int lane) const {
        return static_cast<std::size_t>(phase) * static_cast<std::size_t>(lanes_.lanes()) +
               static_cast<std::size_t>(lane);
    }

    void append_interface(const SurfaceValues& interface) {
        ++record_.layer_count;
        WalkPartRecord& part = out_.walk_parts.emplace_back(surface_part(interface));
        part.eta = static_cast<float>(interface.ior_below / interface.ior_above);
        part.ior = static_cast<float>(interface.ior_below);
        if (const auto flux = walk_surface(interface).lost)
            part.cavities = append_cavities(*flux);
    }

    std::uint32_t append_cavities(const LostFlux& flux) {
        const std::uint32_t offset = lanes_.here();
        for (const double value : flux.table())
            lanes_.append(value);
        return offset;
    }

    /// The slab's, in the part of the interface above it.
    void append_slab(double anisotropy, WalkPartRecord& part) {
        const std::size_t own = from_ == Side::Above ? record_.layer_count - 1
                                                     : plan_.slabs.size() - record_.layer_count;
        const SlabDepths& depths = plan_.slabs[own];
        if (!depths.absorbs() && !depths.scatters())
            return;
        const Layer& layer = material_.stack.layers[own];
        part.least_depth = static_cast<float>(
            *std::min_element(depths.absorption.begin(), depths.absorption.end()));
        part.extinction = lanes_.append_lanes(
            [&](int phase, int lane) { return depths.extinction(index(phase, lane)); });
        if (depths.scatters()) {
            part.scattering = lanes_.append_lanes(
                [&](int phase, int lane) { return depths.scattering[index(phase, lane)]; });
            part.anisotropy = static_cast<float>(anisotropy);
        }
        if (layer.is_dyed())
            append_dyes(layer, depths, part);
        else if (depths.scatters())
            set_references(depths, {}, part);
    }

    /// What the dyes send out, by columns.
    void append_dyes(const Layer& layer, const SlabDepths& depths, WalkPartRecord& part) {
        std::vector<double> emitted;
        part.emission = lanes_.here();
        for (const Eigen::MatrixXd& sent : dyes_on_lanes(layer, lanes_.plan())) {
            append_columns(sent);
            for (const double sum : sent.rowwise().sum().eval())
                emitted.push_back(sum);
        }
        set_references(depths, emitted, part);
        const double most_emitted = *std::ranges::max_element(emitted);
        const double most_scattered = *std::ranges::max_element(depths.scattering);
        part.emission_share =
            most_scattered > 0.0
                ? static_cast<float>(std::clamp(most_emitted / (most_emitted + most_scattered),
                                                least_branch, 1.0 - least_branch))
                : 1.0f;
    }

    void append_columns(const Eigen::MatrixXd& matrix) {
        for (int i = 0; i < lanes_.padded_lanes(); ++i)
            for (int o = 0; o < lanes_.padded_lanes(); ++o)
                lanes_.append(i < lanes_.lanes() && o < lanes_.lanes() ? matrix(o, i) : 0.0);
    }

    /// The operator of the bare substrate, M / pi: what the stack sends back to it is walked.
    void append_substrate_part() {
        Material bare = material_;
        bare.stack.layers.clear();
        const MaterialOptics nothing(Material{}, Model::Adding, lanes_.plan());
        const LaneOperator middle =
            append_substrate(bare, Model::Adding, nothing, *plan_.on_cells, lanes_, record_, out_);
        if (conductor_of(stack_)) {
            append_conductor(stack_.size() - 1);
            return;
        }
        WalkPartRecord part = surface_part({.scattering = Scattering::Single});
        part.albedo = static_cast<float>(
            std::clamp(std::numbers::pi * middle.row_sums().maxCoeff(), 0.0, 1.0));
        out_.walk_parts.push_back(part);
    }

    /// A conductor in a medium. Its reflectance at a facet is tabulated over the cosine there.
    void append_conductor(std::size_t element) {
        const auto surface = [&](int phase, int lane) -> const SurfaceValues& {
            return *surface_of(lane_stacks_[index(phase, lane)][element]);
        };
        const SurfaceValues& at_reference = *surface_of(stack_[element]);
        WalkPartRecord part = surface_part(at_reference);
        part.reflectance = lanes_.append_nodes_of_lanes([&](double cosine, int phase, int lane) {
            return facet_reflectance(surface(phase, lane), cosine);
        });
        double largest = 0.0;
        for (int lane = 0; lane < lanes_.lanes(); ++lane)
            largest = std::max(largest, facet_reflectance(surface(lanes_.phases() / 2, lane), 1.0));
        part.albedo = static_cast<float>(largest);
        if (const auto flux = walk_surface(at_reference).lost) {
            part.cavities = append_cavities(*flux);
            part.bounced = lanes_.append_lanes([&](int phase, int lane) {
                return walk_surface(surface(phase, lane)).lost_reflectance;
            });
        }
        out_.walk_parts.push_back(part);
    }

    /// Sheets of flakes, after the substrate.
    void append_flakes() {
        std::uint32_t layers = 0;
        for (std::size_t e = 0; e < stack_.size(); ++e) {
            layers += std::holds_alternative<SlabValues>(stack_[e]) ? 1u : 0u;
            const auto* flakes = std::get_if<FlakesValues>(&stack_[e]);
            if (!flakes)
                continue;
            WalkPartRecord& slab = out_.walk_parts[record_.walk + layers - 1];
            slab.flakes = static_cast<std::uint32_t>(out_.walk_parts.size()) - record_.walk;
            slab.coverage = static_cast<float>(flakes->coverage);
            append_conductor(e);
        }
    }

    const Material& material_;
    const MaterialPlan& plan_;
    Side from_;
    StackElements stack_; ///< at the reference wavelength
    SceneTables& out_;
    LaneTables lanes_;
    std::vector<StackElements> lane_stacks_; ///< [phase][lane]
    MaterialRecord record_{};
};

} // namespace

void append_walk_material(const Material& material, const MaterialPlan& plan,
                          const WavelengthPlan& wavelengths, SceneTables& tables) {
    WalkTables(material, plan, wavelengths, Side::Above, tables).append();
}

void append_walked_other_side(const Material& material, const MaterialPlan& plan,
                              const WavelengthPlan& wavelengths, std::size_t above,
                              SceneTables& tables) {
    const auto below = static_cast<std::uint32_t>(tables.materials.size());
    WalkTables(material, plan, wavelengths, Side::Below, tables).append();
    tables.materials[above].other_side = below;
    tables.materials[below].other_side = static_cast<std::uint32_t>(above);
}

} // namespace reradiant
