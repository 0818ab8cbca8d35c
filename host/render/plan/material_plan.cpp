#include "host/render/plan/material_plan.h"

#include "host/layers/models/weidlich_wilkie_bsdf.h"
#include "host/layers/stack/stack_variants.h"
#include "host/layers/walk/walk_surface.h"
#include "host/render/dyes/dyed_operator.h"
#include "host/render/tables/stack_optics.h"
#include "host/render/tables/substrate_operator.h"
#include "host/scene/model/closed_model.h"
#include "kernels/core/shared.h"
#include "kernels/scatter/lobe_ratio.h"
#include "kernels/scatter/shape_table.h"
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
bool is_tabulated(const SurfaceValues& surface) {
    return surface.is_conductor || surface.has_film();
}

/// An interface between equal media without a film is not seen.
bool reflects(const SurfaceValues& surface) {
    return is_tabulated(surface) || surface.ior_below != surface.ior_above;
}

/// Fills the plan of one material.
class MaterialPlanner {
public:
    MaterialPlanner(const Material& material, const ModelChoice& choice,
                    const WavelengthPlan& wavelengths)
        : material_(material), stack_(material_at(material, reference_nm)),
          parts_(reflecting_elements(stack_)), wavelengths_(wavelengths),
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
        if (plan_.choice.model != Model::Walk || !material_.stack.is_sheet())
            plan_substrate();
        if (material_.stack.is_dyed() && plan_.choice.model != Model::Walk)
            plan_dyes();
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
        plan_parts();
        plan_lobes();
        if (plan_.choice.model == Model::WeidlichWilkie)
            find_specular_of_parts();
        else
            find_specular_of_adding();
        plan_.features.smooth = plan_.has_delta;
        plan_.features.scattering_slabs = material_.stack.scatters();
        plan_.features.spectral_stack = depends_on_wavelength(material_);
        const std::uint64_t tables = 1 + (plan_.has_delta ? 1 : 0) + (plan_.has_residual ? 1 : 0) +
                                     plan_.counts.lobes; // transmission first
        const std::uint64_t nodes = plan_.features.spectral_stack ? spectral_nodes() : TABLE_NODES;
        plan_.counts.floats += tables * nodes;
        if (material_.stack.is_sheet())
            plan_sheet(nodes);
    }

    /// A sheet has records of its own for each side, and what goes through it.
    void plan_sheet(std::uint64_t nodes) {
        plan_.features.sheets = true;
        plan_.counts.materials = 2;
        plan_.counts.layers *= 2;
        plan_.counts.lobes *= 2;
        plan_.counts.floats *= 2;
        plan_.counts.floats += returned_ratio_count(upside_down(stack_)) * LOBE_RATIO_SIZE;
        plan_.counts.floats -= returned_ratio_count(stack_) * LOBE_RATIO_SIZE;
        const bool is_rough = !material_.stack.is_smooth();
        plan_.is_straight = !is_rough;
        plan_.counts.floats += row_; // a substrate that sends nothing back, for the other side
        // straight on, or the amplitudes of a lobe and its shape
        plan_.counts.floats += is_rough ? 2 * nodes + LOBE_RATIO_SIZE : nodes;
        if (is_rough || material_.stack.scatters())
            plan_.counts.floats += 2 * nodes;
        if (wavelengths_.hero > 0)
            throw_input_error(material_.position,
                              fmt::format("material '{}': sheets do not go with hero wavelengths",
                                          material_.name),
                              "take --wavelengths comb");
    }

    /// The surface of a part at the reference wavelength.
    const SurfaceValues& part(std::size_t p) const { return *surface_of(stack_[parts_[p]]); }

    /// Returns true where `holds` does for the stack at some wavelength; of a stack it may ask for
    /// the IORs, widths and films of its interfaces.
    bool at_any_wavelength(const std::function<bool(const StackElements&)>& holds) const {
        if (!material_.stack.is_dispersive())
            return holds(stack_);
        for (int phase = 0; phase < wavelengths_.phases; ++phase)
            for (int lane = 0; lane < static_cast<int>(wavelengths_.lanes.size()); ++lane)
                if (holds(material_at(material_, wavelengths_.wavelength_nm(lane, phase))))
                    return true;
        return false;
    }

    /// Under adding smooth interfaces make a mirror down to the first rough one, and the residual
    /// takes what rough ones and slabs scatter.
    void find_specular_of_adding() {
        const auto has_mirror = [](const StackElements& stack) {
            for (const StackElement& element : above_substrate(stack)) {
                const auto* interface = std::get_if<SurfaceValues>(&element);
                if (interface && interface->scatters())
                    return false;
                if (interface && reflects(*interface))
                    return true;
            }
            return false;
        };
        plan_.has_delta = at_any_wavelength([&](const StackElements& stack) {
            return has_mirror(stack) ||
                   (material_.stack.is_sheet() && has_mirror(upside_down(stack)));
        });
        const bool facets_are_all = has_facet_lobe(stack_) && !material_.stack.is_sheet() &&
                                    material_.stack.layers.size() == 1 &&
                                    !material_.stack.scatters();
        plan_.has_residual =
            material_.stack.scatters() ||
            (!facets_are_all && at_any_wavelength([](const StackElements& stack) {
                const auto above = above_substrate(stack);
                return std::any_of(above.begin(), above.end(), [](const StackElement& element) {
                    const auto* interface = std::get_if<SurfaceValues>(&element);
                    return interface && interface->scatters();
                });
            }));
    }

    /// Under model A every smooth part is a mirror, and every rough one whose scattering is
    /// `multiple` adds to the residual.
    void find_specular_of_parts() {
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            const SurfaceValues& surface = part(p);
            if (!at_any_wavelength([&](const StackElements& stack) {
                    return reflects(*surface_of(stack[parts_[p]]));
                }))
                continue;
            plan_.has_delta |= surface.alpha == 0.0;
            plan_.has_residual |= surface.alpha > 0.0 && surface.scattering == Scattering::Multiple;
        }
    }

    bool has_rough_top() const {
        if (parts_.empty())
            return false;
        return part(0).alpha > 0.0 ||
               (material_.stack.is_sheet() && part(parts_.size() - 1).alpha > 0.0);
    }

    /// Finds what the kernels evaluate for themselves, and whether lane by lane.
    void plan_parts() {
        const bool nested = plan_.choice.model == Model::WeidlichWilkie && !is_all_smooth(stack_);
        const LayerStack& spectra = material_.stack;
        const bool dispersive = spectra.is_dispersive();
        plan_.model_a = !nested ? 0u : dispersive ? MODEL_A_PER_LANE : MODEL_A;
        plan_.features.weidlich_wilkie = nested;
        plan_.features.rough = has_rough_top();
        if (nested && dispersive)
            plan_.ior_ratios = parts_.size();
        else if (plan_.features.rough && !spectra.layers.empty() &&
                 !spectra.layers.front().ior.is_constant())
            plan_.ior_ratios = 1;
        for (std::size_t p = 0; nested && p < parts_.size(); ++p)
            if (is_tabulated(part(p)))
                plan_.tabulated.push_back(p);
        plan_.features.dispersion = plan_.ior_ratios > 0;
        plan_.features.tabulated_reflectance = !plan_.tabulated.empty();
        plan_.counts.layers = parts_.size();
        plan_.counts.floats += plan_.ior_ratios * row_ + plan_.tabulated.size() * spectral_nodes();
    }

    bool has_facet_lobe_on_a_side() const {
        return has_facet_lobe(stack_) ||
               (material_.stack.is_sheet() && has_facet_lobe(upside_down(stack_)));
    }

    void plan_lobes() {
        plan_.counts.lobes = static_cast<std::uint64_t>(plan_.features.lobes);
        plan_.features.deeper_lobes = plan_.counts.lobes > 0;
        if (plan_.choice.model == Model::Adding) {
            plan_.counts.floats += (has_facet_lobe_on_a_side() ? SHAPE_TABLE_SIZE : 0) +
                                   returned_ratio_count(stack_) * LOBE_RATIO_SIZE;
        }
        if (plan_.choice.model == Model::WeidlichWilkie)
            for (const DeeperLobe& lobe : weidlich_wilkie_lobes(stack_))
                if (std::holds_alternative<SlabValues>(stack_[lobe.element]))
                    plan_.counts.floats += 2 * row_; // optical depth and albedo
    }

    void plan_walk() {
        if (const std::optional<std::string> refusal = device_walk_refusal(material_))
            throw_input_error(material_.position,
                              fmt::format("material '{}': {}", material_.name, *refusal),
                              "use weidlich-wilkie or adding, or measure the material by walk");
        plan_slabs();
        plan_.counts.walk_parts = plan_.slabs.size() + 1;
        for (const std::size_t e : parts_) {
            const SurfaceValues& surface = *surface_of(stack_[e]);
            plan_.counts.walk_parts += std::holds_alternative<FlakesValues>(stack_[e]) ? 1 : 0;
            plan_walked_surface(surface);
        }
        if (material_.stack.is_sheet()) {
            plan_.features.sheets = true;
            plan_.counts.materials = 2;
            plan_.counts.walk_parts *= 2;
            plan_.counts.floats *= 2;
        }
    }

    void plan_slabs() {
        for (const StackElement& element : stack_)
            if (std::holds_alternative<SlabValues>(element))
                plan_.slabs.emplace_back();
        for (int phase = 0; phase < wavelengths_.phases; ++phase)
            for (int lane = 0; lane < static_cast<int>(wavelengths_.lanes.size()); ++lane)
                append_depths(material_at(material_, wavelengths_.wavelength_nm(lane, phase)));
        for (std::size_t k = 0; k < plan_.slabs.size(); ++k) {
            const SlabDepths& slab = plan_.slabs[k];
            const bool is_dyed = material_.stack.layers[k].is_dyed();
            plan_.features.walked_dyes |= is_dyed;
            plan_.features.scattering_slabs |= slab.scatters() || is_dyed;
            plan_.counts.floats += (slab.scatters()  ? 2
                                    : slab.absorbs() ? 1
                                                     : 0) *
                                       row_ +
                                   (is_dyed ? lanes_ * row_ : 0);
        }
    }

    void append_depths(const StackElements& stack) {
        auto depths = plan_.slabs.begin();
        for (const StackElement& element : stack) {
            if (const auto* slab = std::get_if<SlabValues>(&element)) {
                depths->absorption.push_back(slab->tau);
                depths->scattering.push_back(slab->tau_scattering);
                ++depths;
            }
        }
    }

    /// A conductor's reflectance is tabulated; of what V-cavities lose there is the table that
    /// kernels/walk/walk_cavities.h reads, and what a conductor keeps of it.
    void plan_walked_surface(const SurfaceValues& surface) {
        const std::shared_ptr<const LostFlux> lost = walk_surface(surface).lost;
        if (lost)
            plan_.counts.floats += lost->table().size();
        if (!surface.is_conductor)
            return;
        plan_.features.tabulated_reflectance = true;
        plan_.counts.floats += spectral_nodes() + (lost ? row_ : 0);
    }

    void plan_substrate() {
        plan_.features.oren_nayar = sigma() > 0.0;
        SubstrateOnCells on_cells;
        if (!is_conductor())
            on_cells = substrate_on_cells(material_.substrate, wavelengths_.comb);
        plan_.on_cells = std::make_shared<SubstrateOnCells>(on_cells);
        // the first bounce stands apart where light comes back to the substrate
        const bool has_first =
            sigma() > 0.0 && plan_.choice.model == Model::Adding && !material_.stack.layers.empty();
        if (has_first)
            plan_.counts.floats += SHAPE_COSINES + (spreads_in_the_middle() ? SHAPE_TABLE_SIZE : 0);
        if (plan_.features.reflectance_image) {
            plan_.counts.floats += 5 * row_; // scale, r of the stack, a spectrum for each colour
            return;
        }
        const bool fluoresces = on_cells.fluorescence.size() > 0;
        plan_.features.fluorescence = fluoresces;
        plan_.features.dense_matrix = fluoresces && !on_cells.is_factored();
        const std::uint64_t dense = plan_.features.dense_matrix ? lanes_ : 0;
        const auto factors = 2 * static_cast<std::uint64_t>(on_cells.emission.cols());
        plan_.counts.floats += (has_first ? 2 : 1) * (1 + factors + dense) * row_;
        if (fluoresces && wavelengths_.hero > 0)
            plan_.counts.floats += lanes_ * row_; // probabilities of each shift
    }

    /// Dyes and substrate send out light together. Under adding they do so by channels.
    void plan_dyes() {
        const auto refuse = [&](const char* reason, const char* remedy) {
            throw_input_error(material_.position,
                              fmt::format("material '{}': {}", material_.name, reason), remedy);
        };
        if (wavelengths_.hero > 0)
            refuse("dyes in layers do not go with hero wavelengths", "take --wavelengths comb");
        if (plan_.features.reflectance_image)
            refuse("a reflectance beneath dyed layers cannot be an image",
                   "give it one reflectance, or make the concentration of a dye follow the image");
        plan_.dyes =
            std::make_shared<DyedOperator>(dyed_operator(material_, *plan_.on_cells, wavelengths_));
        const auto channels = static_cast<std::uint64_t>(plan_.dyes->channels);
        plan_.features.dyes = true;
        plan_.features.dye_channels = plan_.dyes->channels;
        const std::uint64_t sides = material_.stack.is_sheet() ? 2 : 1;
        plan_.counts.floats += sides * channels * spectral_nodes() +
                               channels *
                                   (channels * (plan_.dyes->terms > 0 ? 1 : lanes_) +
                                    2 * static_cast<std::uint64_t>(plan_.dyes->terms)) *
                                   row_;
    }

    /// True where light is spread on its way to the substrate at the middle of the spectrum, for
    /// which the kernels have an Oren-Nayar substrate's shape.
    bool spreads_in_the_middle() const {
        const StackElements stack = material_at(
            material_, wavelengths_.wavelength_nm(static_cast<int>(wavelengths_.lanes.size()) / 2,
                                                  wavelengths_.phases / 2));
        const auto above = above_substrate(stack);
        return std::any_of(above.begin(), above.end(), scatters);
    }

    const Material& material_;
    StackElements stack_;            ///< at the reference wavelength
    std::vector<std::size_t> parts_; ///< elements that reflect
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
        features.walk_layers =
            static_cast<int>(material.stack.layers.size()) + (material.stack.is_sheet() ? 1 : 0);
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
