#pragma once

#include "host/render/plan/render_features.h"
#include "host/scene/model/model_choice.h"
#include "reradiant/wavelength_plan.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace reradiant {

struct DyedOperator;
struct SubstrateOnCells;

/// A slab's optical depths at normal passage, [phase][lane].
struct SlabDepths {
    std::vector<double> absorption, scattering;

    double extinction(std::size_t i) const { return absorption[i] + scattering[i]; }
    bool absorbs() const;
    bool scatters() const;
};

/// Records and floats that one material adds to the tables at most; its choice table, which depends
/// on the whole scene, is not counted.
struct TableCounts {
    std::uint64_t materials = 1, layers = 0, lobes = 0, walk_parts = 0, floats = 0;
};

/// A `MaterialPlan` says what one material of a render needs, and holds what finding that out took
/// time for; the table writers read both.
struct MaterialPlan {
    ModelChoice choice;
    RenderFeatures features; ///< the bits and sizes that this material needs
    TableCounts counts;
    std::shared_ptr<const SubstrateOnCells> on_cells; ///< of a conductor: nothing

    /// What dyes in the slabs send out, and the substrate with them; null without dyes.
    std::shared_ptr<const DyedOperator> dyes;

    // closed models
    bool has_delta = false, has_residual = false; ///< a mirror, light between facets or slabs
    bool is_straight = false;   ///< of a sheet whose faces are smooth: light passes straight on
    std::uint32_t model_a = 0;  ///< MaterialRecord::weidlich_wilkie
    std::size_t ior_ratios = 0; ///< the first parts, whose IOR ratios go lane by lane
    std::vector<std::size_t> tabulated; ///< parts whose reflectance at facets is tabulated

    // walk
    std::vector<SlabDepths> slabs; ///< of every layer
};

/// Returns the features of a material that size what a path keeps: known at once, without the
/// analysis that plan_material does.
RenderFeatures features_of_model(const Material& material, Model model);

/// Analyses a material under the model that was chosen for it. Input Error at the material for what
/// the model cannot do.
MaterialPlan plan_material(const Material& material, const ModelChoice& choice,
                           const WavelengthPlan& wavelengths);

} // namespace reradiant
