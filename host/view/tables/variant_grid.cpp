#include "host/view/tables/variant_grid.h"

#include "host/scene/model/closed_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reradiant {

namespace {

/// Widths that the roughness slider goes through; what lies between is interpolated.
constexpr double slider_alphas[] = {0.0, 0.05, 0.1, 0.2, 0.35, 0.6};
/// Depths over the largest of the material: sliders multiply thickness and absorption by up to 4
/// each. One factor on all depths is tabulated at fewer places, as every band is a class.
constexpr double slab_depths[] = {0.0, 0.0625, 0.125, 0.25, 0.375, 0.5, 0.75, 1.0,
                                  1.5, 2.0,    3.0,   4.0,  6.0,   8.0, 12.0, 16.0};
constexpr double factor_depths[] = {0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0};
/// Ranks among the bands' depths that have tables too.
constexpr std::size_t own_depths = 8;
/// More variants than this would make the page large and its making slow.
constexpr std::size_t most_variants = 600;

SlabValues* slab_at(StackElements& stack, std::size_t index) {
    return std::get_if<SlabValues>(&stack[index]);
}

/// Indices of the slabs that absorb at some band.
std::vector<std::size_t> absorbing_slabs(std::vector<StackElements>& stacks) {
    std::vector<std::size_t> found;
    for (std::size_t e = 0; e < stacks.front().size(); ++e)
        if (std::any_of(stacks.begin(), stacks.end(), [&](StackElements& stack) {
                const SlabValues* slab = slab_at(stack, e);
                return slab && slab->tau > 0.0;
            }))
            found.push_back(e);
    return found;
}

SurfaceValues* first_surface(StackElements& stack) {
    for (StackElement& element : stack)
        if (auto* surface = std::get_if<SurfaceValues>(&element))
            return surface;
    return nullptr;
}

/// Sorts the bands' stacks into classes.
void add_classes(VariantGrid& grid, const std::vector<StackElements>& stacks) {
    for (const StackElements& stack : stacks) {
        const auto known = std::find(grid.bases.begin(), grid.bases.end(), stack);
        grid.class_of.push_back(static_cast<std::size_t>(known - grid.bases.begin()));
        if (known == grid.bases.end())
            grid.bases.push_back(stack);
    }
}

/// The bands' stacks as they are: each is a class of its own depth.
VariantGrid fixed_depths(const std::vector<StackElements>& stacks, bool absorbs) {
    VariantGrid grid;
    grid.absorbs = absorbs;
    grid.depths.assign(stacks.size(), 1.0);
    grid.nodes = {1.0};
    add_classes(grid, stacks);
    return grid;
}

/// Depths that are tabulated: those of the slider, and some of the bands' own, so that the material
/// as it is lies close to them.
std::vector<double> depth_nodes(std::vector<double> own, bool with_sliders) {
    std::sort(own.begin(), own.end());
    const double largest = own.back();
    std::vector<double> nodes;
    for (const double depth : slab_depths)
        if (with_sliders || depth <= 1.0)
            nodes.push_back(depth * largest);
    for (std::size_t k = 1; k < own_depths; ++k) {
        const double depth = own[k * (own.size() - 1) / own_depths];
        if (std::none_of(nodes.begin(), nodes.end(),
                         [&](double node) { return std::fabs(node - depth) < 0.02 * largest; }))
            nodes.push_back(depth);
    }
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

/// Classes that sliders of thickness and absorption move along: by the depth of the one slab that
/// absorbs, else by a factor on all depths. Up to the depth that there is, without sliders.
VariantGrid moving_depths(std::vector<StackElements> stacks,
                          const std::vector<std::size_t>& absorbing, bool with_sliders) {
    VariantGrid grid;
    grid.absorbs = true;
    grid.depths.assign(stacks.size(), 1.0);
    if (absorbing.size() > 1) {
        grid.nodes.assign(std::begin(factor_depths), std::end(factor_depths));
    } else {
        for (std::size_t band = 0; band < stacks.size(); ++band)
            grid.depths[band] = std::exchange(slab_at(stacks[band], absorbing.front())->tau, 1.0);
        grid.nodes = depth_nodes(grid.depths, with_sliders);
    }
    add_classes(grid, stacks);
    return grid;
}

VariantGrid chosen_depths(const std::vector<StackElements>& stacks,
                          const std::vector<std::size_t>& absorbing, bool with_sliders) {
    VariantGrid fixed = fixed_depths(stacks, !absorbing.empty());
    if (absorbing.empty())
        return fixed;
    VariantGrid moving = moving_depths(stacks, absorbing, with_sliders);
    const auto stacks_of = [](const VariantGrid& grid) {
        return grid.bases.size() * grid.nodes.size();
    };
    return with_sliders || stacks_of(moving) < stacks_of(fixed) ? moving : fixed;
}

/// Widths of the first surface. One that bears a film keeps its own.
void choose_alphas(VariantGrid& grid, bool with_sliders) {
    const SurfaceValues* surface = first_surface(grid.bases.front());
    grid.alphas = {surface ? surface->alpha : 0.0};
    if (!surface || surface->has_film() || !with_sliders)
        return;
    const double own = surface->alpha;
    grid.alphas.assign(std::begin(slider_alphas), std::end(slider_alphas));
    grid.alphas.push_back(own);
    std::sort(grid.alphas.begin(), grid.alphas.end());
    grid.alphas.erase(std::unique(grid.alphas.begin(), grid.alphas.end()), grid.alphas.end());
    const auto place = std::find(grid.alphas.begin(), grid.alphas.end(), own);
    grid.own_alpha = static_cast<std::size_t>(place - grid.alphas.begin());
}

} // namespace

StackElements VariantGrid::stack(std::size_t variant) const {
    const std::size_t node = variant % nodes.size();
    const std::size_t base = variant / nodes.size() % bases.size();
    StackElements varied = bases[base];
    for (StackElement& element : varied)
        if (auto* slab = std::get_if<SlabValues>(&element))
            slab->tau *= nodes[node];
    if (SurfaceValues* surface = first_surface(varied))
        surface->alpha = alphas[variant / nodes.size() / bases.size()];
    return varied;
}

VariantGrid variant_grid(const Material& material, const WavelengthGrid& bands,
                         const VariantRequest& request) {
    std::vector<StackElements> stacks;
    for (const double nm : bands.centres_nm()) {
        stacks.push_back(material_at(material, nm));
        if (!request.with_conductor) {
            const std::span<const StackElement> above = above_substrate(stacks.back());
            stacks.back() = StackElements(above.begin(), above.end());
        }
    }
    const std::vector<std::size_t> absorbing = absorbing_slabs(stacks);
    // where clouds scatter, depth is more than absorption: such a stack stays as thick as it is
    const bool may_move = request.with_sliders && !material.stack.scatters();
    // a rough interface takes its operator a second, and a dispersive one has one at every band
    const bool may_roughen = request.with_sliders && !material.stack.is_dispersive();
    struct Moves {
        bool depth, alpha;
    };
    VariantGrid grid;
    for (const auto [depth, alpha] :
         {Moves{true, true}, {false, true}, {true, false}, {false, false}}) {
        if ((depth && !may_move) || (alpha && !may_roughen))
            continue;
        grid = material.stack.scatters() ? fixed_depths(stacks, !absorbing.empty())
                                         : chosen_depths(stacks, absorbing, depth);
        choose_alphas(grid, alpha);
        if (grid.variants() <= most_variants)
            break;
    }
    return grid;
}

} // namespace reradiant
