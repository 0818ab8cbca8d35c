#include "host/fit/dye/dye_stack.h"

#include "host/layers/sources/coarse_sources.h"
#include "host/layers/stack/slab_emission.h"
#include "reradiant/error.h"

#include <tbb/parallel_for.h>

namespace reradiant {

namespace {

constexpr int cells_per_octave = 4; ///< errors below 1e-5 (tools/docs/dyes-and-sheets.md)

std::vector<StackElements> elements_by_band(const DyeSample& sample, const WavelengthGrid& bands) {
    std::vector<StackElements> by_band;
    for (const double nm : bands.centres_nm()) {
        by_band.push_back(stack_at(sample.stack, nm));
        if (!sample.stack.is_sheet())
            by_band.back() = stack_over(std::move(by_band.back()), DiffuseValues{});
    }
    return by_band;
}

/// Index of the element that is a layer's slab.
std::size_t slab_element(const StackElements& elements, std::size_t layer) {
    for (std::size_t e = 0, slabs = 0; e < elements.size(); ++e)
        if (std::holds_alternative<SlabValues>(elements[e]) && slabs++ == layer)
            return e;
    throw std::invalid_argument("the stack has no such layer");
}

/// Cells that are thin enough at the largest depth in every band.
StackCells cells_for(const DyeSample& sample, const std::vector<StackElements>& by_band,
                     std::size_t element, double largest_depth) {
    DyedStack deepest{by_band, {}, {}};
    for (StackElements& elements : deepest.by_band)
        elements = with_dye(std::move(elements), element, largest_depth);
    for (std::size_t layer = 0; layer < sample.stack.layers.size(); ++layer)
        deepest.slabs.push_back(layer == sample.layer || sample.stack.layers[layer].is_dyed()
                                    ? Eigen::MatrixXd::Zero(1, 1)
                                    : Eigen::MatrixXd());
    return stack_cells(deepest, cells_per_octave);
}

/// Light that total reflection keeps in a lossless sheet goes on for ever, and any dye at all,
/// however little, takes the whole of it: no fit could follow that.
void refuse_lossless_guides(const DyeSample& sample, const std::vector<StackElements>& by_band) {
    constexpr double least_depth = 1e-4;
    if (!sample.stack.is_sheet() || std::ranges::any_of(by_band.front(), scatters))
        return;
    for (const StackElements& elements : by_band) {
        double depth = 0.0, largest_ior = 1.0;
        for (const StackElement& element : elements)
            if (const auto* slab = std::get_if<SlabValues>(&element)) {
                depth += slab->depth();
                largest_ior = std::max(largest_ior, slab->ior);
            }
        if (largest_ior > 1.0 && depth < least_depth)
            throw_input_error({},
                              "total reflection keeps light in a smooth sheet that does not absorb "
                              "any, and the least of a dye would take all of it",
                              "give the sheet's own absorption, of a depth of 0.0001 at least");
    }
}

} // namespace

DyeStack::DyeStack(const DyeSample& sample, const WavelengthGrid& bands, double largest_depth)
    : bands_(bands), largest_depth_(largest_depth),
      views_(static_cast<Eigen::Index>(sample.views.size())) {
    const std::vector<StackElements> by_band = elements_by_band(sample, bands);
    refuse_lossless_guides(sample, by_band);
    const std::size_t element = slab_element(by_band.front(), sample.layer);
    const StackCells cells = cells_for(sample, by_band, element, largest_depth);
    make_groups(sample, cells, Fine);
    make_groups(sample, coarser(cells), Coarse);
    make_tables(sample, by_band, cells);
}

void DyeStack::make_groups(const DyeSample& sample, const StackCells& cells, Level level) {
    Eigen::Index first = 0;
    for (std::size_t layer = 0; layer < cells.size(); ++layer) {
        const int count = cells[layer].count();
        if (count == 0)
            continue;
        SourceGroup group{first, count, Eigen::VectorXd(count),
                          slab_emission(sample.stack.layers[layer], bands_), layer == sample.layer};
        for (int cell = 0; cell < count; ++cell)
            group.shares(cell) = cells[layer].share(cell);
        groups_[level].push_back(std::move(group));
        first += count;
    }
    if (!sample.stack.is_sheet())
        groups_[level].push_back({first, 1, Eigen::VectorXd::Ones(1), sample.matrix, false});
}

void DyeStack::make_tables(const DyeSample& sample, const std::vector<StackElements>& by_band,
                           const StackCells& cells) {
    const std::size_t element = slab_element(by_band.front(), sample.layer);
    const std::vector<double> depths = DepthTable::node_depths(largest_depth_);
    Eigen::Index cell_count = 0;
    for (const DepthCells& own : cells)
        cell_count += own.count();
    for (std::size_t band = 0; band < by_band.size(); ++band) {
        if (band > 0 && by_band[band] == by_band[band - 1]) {
            for (Tables& tables : tables_)
                tables.push_back(tables.back());
            continue;
        }
        std::vector<std::shared_ptr<const SourceTransport>> fine(depths.size()), coarse = fine;
        tbb::parallel_for(std::size_t{0}, depths.size(), [&](std::size_t k) {
            fine[k] = source_transport(with_dye(by_band[band], element, depths[k]), cells);
            coarse[k] = coarse_sources(fine[k], cell_count);
        });
        tables_[Fine].push_back(std::make_shared<DepthTable>(largest_depth_, fine, sample.views));
        tables_[Coarse].push_back(
            std::make_shared<DepthTable>(largest_depth_, coarse, sample.views));
    }
}

} // namespace reradiant
