#pragma once

#include "host/fit/dye/depth_table.h"
#include "reradiant/layer_stack.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace reradiant {

/// A stack in one of whose layers the dyes are not known.
struct DyeSample {
    LayerStack stack;       ///< without the unknown dyes; all others are known
    std::size_t layer = 0;  ///< index of the layer
    Eigen::MatrixXd matrix; ///< of the Lambertian substrate, (bands, bands); empty for a sheet
    std::vector<DyeView> views;
};

/// Sources that send out by the same matrix: cells of a dyed slab, or the substrate.
struct SourceGroup {
    Eigen::Index first = 0, count = 0;
    Eigen::VectorXd shares; ///< of each source in its slab's thickness
    Eigen::MatrixXd known;  ///< what is sent out whatever the unknown dyes are; empty: nothing
    bool is_unknown = false;
};

/// The transport of a sample by its depth cells, tabulated over the depth of its unknown dyes, with
/// cells and with others twice as thick, whose difference takes the leading error away
/// (EmittingStack).
class DyeStack {
public:
    enum Level { Coarse, Fine };

    /// Depths of unknown dyes reach from 0 to `largest_depth`. Input Error for what adding does not
    /// know, and for a sheet that guides light and absorbs none of it.
    DyeStack(const DyeSample& sample, const WavelengthGrid& bands, double largest_depth);

    const WavelengthGrid& bands() const { return bands_; }
    double largest_depth() const { return largest_depth_; }
    Eigen::Index views() const { return views_; }
    const std::vector<SourceGroup>& groups(Level level) const { return groups_[level]; }
    DepthTransportPair at(Level level, Eigen::Index band, double depth) const {
        return tables_[level][static_cast<std::size_t>(band)]->at(depth);
    }

private:
    using Tables = std::vector<std::shared_ptr<const DepthTable>>;

    void make_groups(const DyeSample& sample, const StackCells& cells, Level level);
    void make_tables(const DyeSample& sample, const std::vector<StackElements>& by_band,
                     const StackCells& cells);

    WavelengthGrid bands_;
    double largest_depth_;
    Eigen::Index views_;
    std::vector<SourceGroup> groups_[2];
    Tables tables_[2]; ///< by band
};

} // namespace reradiant
