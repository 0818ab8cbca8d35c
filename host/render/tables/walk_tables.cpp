#include "host/render/tables/walk_tables.h"

#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/walk/walk_surface.h"
#include "host/render/tables/substrate_tables.h"
#include "host/scene/model/closed_model.h"
#include "host/scene/model/model_choice.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace reradiant {

namespace {

/// Distances in a scattering slab are sampled with extinctions down to this share of the largest:
/// where a lane's is smaller still, weights bounded by WALK_REFERENCES make up for it.
constexpr double least_reference = 1e-3;

void check_material(const Material& material) {
    if (const std::optional<std::string> refusal = device_walk_refusal(material))
        throw_input_error(material.position,
                          fmt::format("material '{}': {}", material.name, *refusal),
                          "use weidlich-wilkie or adding, or measure the material by walk");
}

/// A surface of a stack, or of its substrate; nothing beneath it yet.
WalkPartRecord surface_part(const SurfaceValues& surface) {
    WalkPartRecord part{};
    part.eta = part.ior = 1.0f;
    part.alpha = static_cast<float>(surface.alpha);
    part.distribution = static_cast<std::uint32_t>(kernel_distribution(surface.distribution));
    part.multiple = surface.scattering == Scattering::Multiple ? 1u : 0u;
    part.albedo = 1.0f;
    part.cavities = part.reflectance = part.bounced = NO_INDEX;
    part.extinction = part.scattering = part.flakes = NO_INDEX;
    return part;
}

/// A slab's optical depths at normal passage, all phases and lanes.
struct SlabDepths {
    std::vector<double> absorption, scattering;

    double extinction(std::size_t i) const { return absorption[i] + scattering[i]; }
};

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
    WalkTables(const Material& material, const WavelengthPlan& plan, SceneTables& out)
        : material_(material), stack_(material_at(material, reference_nm)), out_(out),
          lanes_(plan, out.tables) {
        for (int phase = 0; phase < lanes_.phases(); ++phase)
            for (int lane = 0; lane < lanes_.lanes(); ++lane)
                lane_stacks_.push_back(material_at(material, plan.wavelength_nm(lane, phase)));
    }

    void append() {
        record_.walk = static_cast<std::uint32_t>(out_.walk_parts.size());
        const std::size_t end = above_substrate(stack_).size();
        for (std::size_t e = 0; e < end; ++e) {
            if (const auto* interface = std::get_if<SurfaceValues>(&stack_[e]))
                append_interface(*interface);
            else if (std::holds_alternative<SlabValues>(stack_[e]))
                append_slab(e, out_.walk_parts.back());
        }
        append_substrate_part();
        append_flakes();
        out_.features.walk = true;
        out_.features.walk_layers =
            std::max(out_.features.walk_layers, static_cast<int>(record_.layer_count));
        out_.materials.push_back(record_);
    }

private:
    std::size_t index(int phase, int lane) const {
        return static_cast<std::size_t>(phase * lanes_.lanes() + lane);
    }

    void append_interface(const SurfaceValues& interface) {
        ++record_.layer_count;
        WalkPartRecord& part = out_.walk_parts.emplace_back(surface_part(interface));
        part.eta = static_cast<float>(interface.ior_below / interface.ior_above);
        part.ior = static_cast<float>(interface.ior_below);
        if (const auto flux = walk_surface(interface).lost)
            part.cavities = append_cavities(*flux);
    }

    /// The table that kernels/walk/walk_cavities.h reads.
    std::uint32_t append_cavities(const LostFlux& flux) {
        const std::uint32_t offset = lanes_.here();
        const auto append_all = [this](const std::vector<double>& values) {
            for (const double value : values)
                lanes_.append(value);
        };
        const std::vector<LostFlux::Cells>& sides = flux.sides();
        for (std::size_t side = 0; side < 2; ++side)
            lanes_.append(side < sides.size() ? static_cast<double>(sides[side].lost.size()) : 0.0);
        lanes_.append(flux.cumulative().back());
        for (const LostFlux::Cells& cells : sides) {
            append_all(cells.edges);
            append_all(cells.lost);
        }
        append_all(flux.cumulative());
        return offset;
    }

    /// The slab's, in the part of the interface above it.
    void append_slab(std::size_t element, WalkPartRecord& part) {
        SlabDepths depths;
        for (const StackElements& stack : lane_stacks_) {
            const SlabValues& slab = std::get<SlabValues>(stack[element]);
            depths.absorption.push_back(slab.tau);
            depths.scattering.push_back(slab.tau_scattering);
        }
        const auto& [absorption, scattering] = depths;
        const bool absorbs = *std::max_element(absorption.begin(), absorption.end()) > 0.0;
        const bool scatters = *std::max_element(scattering.begin(), scattering.end()) > 0.0;
        if (!absorbs && !scatters)
            return;
        part.least_depth =
            static_cast<float>(*std::min_element(absorption.begin(), absorption.end()));
        part.extinction = lanes_.append_lanes(
            [&](int phase, int lane) { return depths.extinction(index(phase, lane)); });
        if (!scatters)
            return;
        out_.features.scattering_slabs = true;
        part.scattering = lanes_.append_lanes(
            [&](int phase, int lane) { return depths.scattering[index(phase, lane)]; });
        part.anisotropy = static_cast<float>(std::get<SlabValues>(stack_[element]).anisotropy);
        set_references(depths, part);
    }

    /// The operator of the bare substrate, M / pi: what the stack sends back to it is walked.
    void append_substrate_part() {
        Material bare = material_;
        bare.stack.layers.clear();
        const MaterialOptics nothing(Material{}, Model::Adding, lanes_.plan());
        const LaneOperator middle =
            append_substrate(bare, Model::Adding, nothing, lanes_, record_, out_);
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
        out_.features.tabulated_reflectance = true;
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
    StackElements stack_; ///< at the reference wavelength
    SceneTables& out_;
    LaneTables lanes_;
    std::vector<StackElements> lane_stacks_; ///< [phase][lane]
    MaterialRecord record_{};
};

} // namespace

void append_walk_material(const Material& material, const WavelengthPlan& plan,
                          SceneTables& tables) {
    check_material(material);
    WalkTables(material, plan, tables).append();
}

} // namespace reradiant
