#include "host/render/tables/stack_optics.h"

#include "host/layers/models/returned_lobe.h"
#include "host/layers/models/weidlich_wilkie_bsdf.h"
#include "host/scene/model/closed_model.h"
#include "kernels/core/shared.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace reradiant {

namespace {

/// First and last element of what makes a lobe.
struct LobeElements {
    std::size_t first, last;
};

/// Lobes of deeper interfaces that adding makes at most: one for each rough one and for each run of
/// smooth ones beneath a rough one.
std::vector<LobeElements> returned_lobes(const StackElements& stack) {
    std::vector<LobeElements> lobes;
    bool below_rough = false, in_run = false, is_top = true;
    for (std::size_t e = 0; e < above_substrate(stack).size(); ++e) {
        const auto* interface = std::get_if<SurfaceValues>(&stack[e]);
        if (!interface)
            continue;
        const bool rough = interface->alpha > 0.0;
        if (in_run && !rough)
            lobes.back().last = e;
        else if (!is_top && (rough || below_rough))
            lobes.push_back({e, e});
        below_rough = below_rough || rough;
        in_run = below_rough && !rough;
        is_top = false;
    }
    return lobes;
}

/// Lobes besides the top one that adding makes at most: one of the light between the top's facets,
/// and those of deeper interfaces.
int adding_lobe_count(const StackElements& stack) {
    return (has_facet_lobe(stack) ? 1 : 0) + static_cast<int>(returned_lobes(stack).size());
}

/// A material's stacks, [phase][lane], or the one at the reference wavelength.
std::shared_ptr<const std::vector<StackElements>> stacks_of(const Material& material, bool spectral,
                                                            const WavelengthPlan& plan) {
    const int lanes = static_cast<int>(plan.lanes.size());
    auto stacks = std::make_shared<std::vector<StackElements>>();
    for (int i = 0; i < (spectral ? plan.phases * lanes : 1); ++i)
        stacks->push_back(material_at(material, spectral ? plan.wavelength_nm(i % lanes, i / lanes)
                                                         : reference_nm));
    return stacks;
}

} // namespace

bool has_facet_lobe(const StackElements& stack) {
    const auto* top = stack.empty() ? nullptr : std::get_if<SurfaceValues>(&stack.front());
    return top && !top->is_conductor && top->alpha > 0.0 &&
           top->scattering == Scattering::Multiple && top->distribution != Distribution::Blinn &&
           top->ior_below > 1.0;
}

std::size_t returned_ratio_count(const StackElements& stack) {
    return static_cast<std::size_t>(
        std::ranges::count_if(returned_lobes(stack), [&](const LobeElements& lobe) {
            return has_returned_ratio(stack, lobe.first, lobe.last);
        }));
}

bool depends_on_wavelength(const Material& material) {
    const Conductor& metal = material.substrate.conductor;
    return !material.stack.is_constant() ||
           (material.substrate.type == SubstrateType::Conductor &&
            !(metal.ior.is_constant() && metal.kappa.is_constant() && !metal.film));
}

int deeper_lobe_count(const Material& material, Model model) {
    if (model != Model::WeidlichWilkie) {
        const int above = adding_lobe_count(material_at(material, reference_nm));
        return material.stack.is_sheet()
                   ? std::max(above,
                              adding_lobe_count(material_at(material, reference_nm, Side::Below)))
                   : above;
    }
    return static_cast<int>(weidlich_wilkie_lobes(material_at(material, reference_nm)).size());
}

MaterialOptics::MaterialOptics(const Material& material, Model model, const WavelengthPlan& plan)
    : spectral_(depends_on_wavelength(material)), lanes_(static_cast<int>(plan.lanes.size())),
      model_(model), stacks_(stacks_of(material, spectral_, plan)) {
    make(material.stack.is_sheet());
}

MaterialOptics::MaterialOptics(const Material& material, Model model, const WavelengthPlan& plan,
                               std::deque<MaterialOptics>& recent)
    : spectral_(depends_on_wavelength(material)), lanes_(static_cast<int>(plan.lanes.size())),
      model_(model), stacks_(stacks_of(material, spectral_, plan)) {
    const bool is_sheet = material.stack.is_sheet();
    const auto known = std::ranges::find_if(recent, [&](const MaterialOptics& other) {
        return other.model_ == model && other.spectral_ == spectral_ &&
               other.is_sheet() == is_sheet && *other.stacks_ == *stacks_;
    });
    if (known == recent.end()) {
        make(is_sheet);
    } else {
        *this = *known;
        recent.erase(known);
    }
    recent.push_front(*this);
    constexpr std::size_t most_kept = 8; // of some there are 10 MB
    if (recent.size() > most_kept)
        recent.pop_back();
}

void MaterialOptics::make(bool is_sheet) {
    const std::size_t count = stacks_->size();
    is_sheet ? sheets_.resize(count) : optics_.resize(count);
    const auto lobe = is_sheet ? through_lobe(*stacks_) : nullptr;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const StackElements& stack = (*stacks_)[i];
        if (is_sheet)
            sheets_[i] = std::make_shared<SheetTransmission>(stack, lobe);
        else
            optics_[i] = closed_model(model_)(stack);
    });
}

MaterialOptics MaterialOptics::seen_from(Side side) const {
    MaterialOptics other = *this;
    other.side_ = side;
    return other;
}

} // namespace reradiant
