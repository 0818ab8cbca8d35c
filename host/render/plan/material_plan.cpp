#include "host/render/plan/material_plan.h"

#include "host/layers/angular/angular_system.h"
#include "host/layers/walk/walk_surface.h"
#include "host/render/tables/stack_optics.h"
#include "host/render/tables/stack_parts.h"
#include "host/render/tables/substrate_operator.h"
#include "kernels/core/shared.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>

namespace reradiant {

namespace {

bool any_positive(const std::vector<double>& values) {
    return std::any_of(values.begin(), values.end(), [](double value) { return value > 0.0; });
}

/// Fresnel's bare dielectric is the only reflectance that kernels know by themselves.
bool is_tabulated(const Material& material, const StackPart& part) {
    if (part.kind != StackPart::Kind::Interface)
        return true;
    const std::optional<ThinFilm>& film = material.stack.layers[part.layer].film;
    return film && film->thickness_nm > 0.0;
}

/// Fills the plan of one material.
class MaterialPlanner {
public:
    MaterialPlanner(const Material& material, const ModelChoice& choice,
                    const WavelengthPlan& wavelengths)
        : material_(material), layers_(material.stack.layers), wavelengths_(wavelengths),
          lanes_(static_cast<std::uint64_t>(wavelengths.padded_lanes())),
          row_(static_cast<std::uint64_t>(wavelengths.phases) * lanes_) {
        plan_.choice = choice;
        plan_.features = features_of_model(material, choice.model);
    }

    MaterialPlan plan() {
        if (plan_.choice.model == Model::Walk)
            plan_walk();
        else
            plan_closed_model();
        plan_substrate();
        return std::move(plan_);
    }

private:
    bool is_conductor() const { return material_.substrate.type == SubstrateType::Conductor; }
    double sigma() const {
        return material_.substrate.type == SubstrateType::OrenNayar ? material_.substrate.sigma
                                                                    : 0.0;
    }
    /// [phase][node][lane]
    std::uint64_t spectral_nodes() const { return row_ * TABLE_NODES; }

    void plan_closed_model() {
        const std::vector<StackPart> parts = stack_parts(material_);
        plan_parts(parts);
        plan_lobes();
        if (plan_.choice.model == Model::WeidlichWilkie)
            find_specular_of_parts(parts);
        else
            find_specular_of_adding();
        plan_.features.smooth = plan_.has_delta;
        plan_.features.scattering_slabs = material_.stack.scatters();
        plan_.features.spectral_stack = depends_on_wavelength(material_);
        const std::uint64_t tables = 1 + (plan_.has_delta ? 1 : 0) + (plan_.has_residual ? 1 : 0) +
                                     plan_.counts.lobes; // transmission first
        plan_.counts.floats +=
            tables * (plan_.features.spectral_stack ? spectral_nodes() : TABLE_NODES);
    }

    /// Returns true where `holds` does for the stack at some wavelength; of a stack it may ask for
    /// IORs, widths and films.
    bool at_any_wavelength(const std::function<bool(const StackValues&)>& holds) const {
        if (!material_.stack.is_dispersive())
            return holds(stack_at(material_.stack, reference_nm));
        for (int phase = 0; phase < wavelengths_.phases; ++phase)
            for (int lane = 0; lane < static_cast<int>(wavelengths_.lanes.size()); ++lane)
                if (holds(stack_at(material_.stack, wavelengths_.wavelength_nm(lane, phase))))
                    return true;
        return false;
    }

    static bool changes_ior(const StackValues& stack, std::size_t k) {
        return stack[k].ior != (k > 0 ? stack[k - 1].ior : 1.0) || stack[k].film.thickness_nm > 0.0;
    }

    /// Under adding smooth interfaces make a mirror down to the first rough one, and the residual
    /// takes what rough ones and slabs scatter.
    void find_specular_of_adding() {
        const auto first_rough = [](const StackValues& stack) {
            std::size_t k = 0;
            while (k < stack.size() && !is_rough_interface(stack, k))
                ++k;
            return k;
        };
        plan_.has_delta = at_any_wavelength([&](const StackValues& stack) {
            for (std::size_t k = 0; k < first_rough(stack); ++k)
                if (changes_ior(stack, k))
                    return true;
            return false;
        });
        plan_.has_residual =
            material_.stack.scatters() || at_any_wavelength([&](const StackValues& stack) {
                return first_rough(stack) < stack.size();
            });
    }

    /// Under model A every smooth part is a mirror, and every rough one whose scattering is
    /// `multiple` adds to the residual.
    void find_specular_of_parts(const std::vector<StackPart>& parts) {
        for (const StackPart& part : parts) {
            const bool reflects = part.kind != StackPart::Kind::Interface ||
                                  at_any_wavelength([&](const StackValues& stack) {
                                      return changes_ior(stack, part.layer);
                                  });
            plan_.has_delta |= reflects && part.alpha == 0.0;
            plan_.has_residual |= reflects && part.alpha > 0.0 && is_multiple(part);
        }
    }

    bool is_multiple(const StackPart& part) const {
        switch (part.kind) {
        case StackPart::Kind::Interface:
            return layers_[part.layer].scattering == Scattering::Multiple;
        case StackPart::Kind::Flakes:
            return layers_[part.layer].flakes->reflector.scattering == Scattering::Multiple;
        case StackPart::Kind::Conductor:
            break;
        }
        return material_.substrate.conductor.scattering == Scattering::Multiple;
    }

    /// Finds what the kernels evaluate for themselves, and whether lane by lane.
    void plan_parts(const std::vector<StackPart>& parts) {
        const bool nested =
            plan_.choice.model == Model::WeidlichWilkie && !is_all_smooth(material_);
        const bool dispersive = material_.stack.is_dispersive();
        plan_.model_a = !nested ? 0u : dispersive ? MODEL_A_PER_LANE : MODEL_A;
        plan_.features.weidlich_wilkie = nested;
        plan_.features.rough = !parts.empty() && parts.front().alpha > 0.0;
        if (nested && dispersive)
            plan_.ior_ratios = parts.size();
        else if (plan_.features.rough && !layers_.empty() && !layers_.front().ior.is_constant())
            plan_.ior_ratios = 1;
        for (std::size_t p = 0; nested && p < parts.size(); ++p)
            if (is_tabulated(material_, parts[p]))
                plan_.tabulated.push_back(p);
        plan_.features.dispersion = plan_.ior_ratios > 0;
        plan_.features.tabulated_reflectance = !plan_.tabulated.empty();
        plan_.counts.layers = parts.size();
        plan_.counts.floats += plan_.ior_ratios * row_ + plan_.tabulated.size() * spectral_nodes();
    }

    void plan_lobes() {
        plan_.counts.lobes = static_cast<std::uint64_t>(plan_.features.lobes);
        plan_.features.deeper_lobes = plan_.counts.lobes > 0;
        if (plan_.choice.model == Model::WeidlichWilkie)
            for (const DeeperLobe& lobe : weidlich_wilkie_lobes(material_))
                plan_.counts.floats += lobe.is_slab ? 2 * row_ : 0; // optical depth and albedo
    }

    void plan_walk() {
        if (const std::optional<std::string> refusal = device_walk_refusal(material_))
            throw_input_error(material_.position,
                              fmt::format("material '{}': {}", material_.name, *refusal),
                              "use weidlich-wilkie or adding, or measure the material by walk");
        plan_.counts.walk_parts = layers_.size() + 1;
        for (std::size_t k = 0; k < layers_.size(); ++k) {
            plan_slab(layers_[k]);
            count_cavities(interface_surface(stack_at(material_.stack, reference_nm), k));
            if (layers_[k].flakes && layers_[k].flakes->coverage > 0.0) {
                ++plan_.counts.walk_parts;
                plan_walked_conductor(layers_[k].flakes->reflector, layers_[k].ior(reference_nm));
            }
        }
        if (is_conductor())
            plan_walked_conductor(material_.substrate.conductor,
                                  layers_.empty() ? 1.0 : layers_.back().ior(reference_nm));
    }

    void plan_slab(const Layer& layer) {
        SlabDepths slab;
        for (int phase = 0; phase < wavelengths_.phases; ++phase)
            for (int lane = 0; lane < static_cast<int>(wavelengths_.lanes.size()); ++lane) {
                const double nm = wavelengths_.wavelength_nm(lane, phase);
                slab.absorption.push_back(layer.thickness * layer.absorption(nm));
                slab.scattering.push_back(layer.thickness * layer.scattering_coefficient(nm));
            }
        const bool scatters = slab.scatters();
        plan_.features.scattering_slabs |= scatters;
        plan_.counts.floats += (scatters ? 2 : slab.absorbs() ? 1 : 0) * row_;
        plan_.slabs.push_back(std::move(slab));
    }

    /// The table that kernels/walk/walk_cavities.h reads; returns false where there is none.
    bool count_cavities(const WalkSurface& surface) {
        if (!surface.lost)
            return false;
        plan_.counts.floats += surface.lost->table().size();
        return true;
    }

    void plan_walked_conductor(const Conductor& conductor, double ior_above) {
        plan_.features.tabulated_reflectance = true;
        plan_.counts.floats += spectral_nodes();
        if (count_cavities(
                conductor_surface(conductor_at(conductor, reference_nm), ior_above, reference_nm)))
            plan_.counts.floats += row_; // what is kept of the light given back
    }

    void plan_substrate() {
        plan_.features.oren_nayar = sigma() > 0.0;
        SubstrateOnCells on_cells;
        if (!is_conductor())
            on_cells = substrate_on_cells(material_.substrate, wavelengths_.comb);
        plan_.on_cells = std::make_shared<SubstrateOnCells>(on_cells);
        if (plan_.features.reflectance_image) {
            plan_.counts.floats += 5 * row_; // scale, r of the stack, a spectrum for each colour
            return;
        }
        const bool fluoresces = on_cells.fluorescence.size() > 0;
        plan_.features.fluorescence = fluoresces;
        plan_.features.dense_matrix = fluoresces && !on_cells.is_factored();
        const std::uint64_t dense = plan_.features.dense_matrix ? lanes_ : 0;
        const auto factors = 2 * static_cast<std::uint64_t>(on_cells.emission.cols());
        // the first bounce stands apart where light comes back to the substrate
        const bool has_first =
            sigma() > 0.0 && plan_.choice.model == Model::Adding && !layers_.empty();
        plan_.counts.floats += (has_first ? 2 : 1) * (1 + factors + dense) * row_;
        if (fluoresces && wavelengths_.hero > 0)
            plan_.counts.floats += lanes_ * row_; // probabilities of each shift
    }

    const Material& material_;
    const std::vector<Layer>& layers_;
    const WavelengthPlan& wavelengths_;
    std::uint64_t lanes_, row_; ///< padded lanes, and those of all phases
    MaterialPlan plan_;
};

} // namespace

bool SlabDepths::absorbs() const {
    return any_positive(absorption);
}

bool SlabDepths::scatters() const {
    return any_positive(scattering);
}

RenderFeatures features_of_model(const Material& material, Model model) {
    RenderFeatures features;
    features.walk = model == Model::Walk;
    if (features.walk)
        features.walk_layers = static_cast<int>(material.stack.layers.size());
    else
        features.lobes = deeper_lobe_count(material, model);
    features.reflectance_image = material.substrate.type != SubstrateType::Conductor &&
                                 material.substrate.reflectance_image >= 0;
    return features;
}

MaterialPlan plan_material(const Material& material, const ModelChoice& choice,
                           const WavelengthPlan& wavelengths) {
    return MaterialPlanner(material, choice, wavelengths).plan();
}

} // namespace reradiant
